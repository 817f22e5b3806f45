// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Sets up VTK's writer; own parts are how zlib is driven, and the stream, which knows why it failed.
#include "picture_file.hpp"

#include <vtkErrorCode.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkZLibDataCompressor.h>
#include <zlib.h>

#include <stdexcept>

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

// The writer offers only files by name to the public.
class StreamWriter final : public vtkXMLPolyDataWriter {
 public:
  static StreamWriter* New() { VTK_STANDARD_NEW_BODY(StreamWriter); }
  void SetStream(std::ostream* stream) { Stream = stream; }
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

void write_picture(vtkPolyData* picture, const std::filesystem::path& target,
                   const std::string& temporary_name, Compression compression) {
  set_up_vtk();
  AtomicFile file(target, temporary_name);
  const vtkNew<StreamWriter> writer;
  writer->SetInputData(picture);
  writer->SetStream(&file.stream());
  // Not appended behind the XML: since expat 2.6, whose changes Debian 12 has taken over, VTK before 9.3 and with it
  // ParaView before 5.12.1 do not find such arrays.
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  choose_compressor(writer, compression);
  const bool complete = writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError;
  file.check();
  if (!complete)
    throw std::runtime_error("VTK cannot write '" + target.string() +
                             "': " + vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode()));
  file.commit();
}

}  // namespace shoal::vtk
