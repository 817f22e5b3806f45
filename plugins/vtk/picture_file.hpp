// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture as a VTP file: XML in which each array stands as binary data, compressed in blocks, in base64.
#pragma once

#include <filesystem>
#include <string>

class vtkPolyData;

namespace shoal::vtk {

// A picture of 100 000 disordered particles with velocity, pressure, density and id, in single precision, costs
// (processor time on a busy machine; `test_plugins.vtk.bench` measures it):
//   none    27 ms   6.40 MB
//   fast    72 ms   4.68 MB   zlib, runs only
//   small  0.9 s    3.68 MB   LZMA level 1
// But for their exponents such data are noise to a compressor, so what matters is how fast it codes: the levels of
// zlib take 2.4 (level 1) to 20 times (level 9) as long as `fast` and gain 4 to 5 %; LZ4 takes a fifth, but gains
// only a third of what `fast` does.
enum class Compression { fast, small, none };

// Atomic: the file is complete or not there. Throws WriteFailed.
void write_picture(vtkPolyData* picture, const std::filesystem::path& target,
                   const std::string& temporary_name, Compression compression);

}  // namespace shoal::vtk
