// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A picture as a VTP file: a header in XML, then all arrays as raw binary, compressed in blocks.
#pragma once

#include <filesystem>
#include <string>

class vtkPolyData;

namespace shoal::vtk {

// Measured with 100 000 disordered particles (points, vector, two scalars, id; 4.8 MB in single precision) on one
// core. Particle data are noise to a compressor but for their exponents, so what matters is entropy coding:
//   none                       5 ms   4.80 MB
//   LZ4                       11 ms   4.40 MB
//   fast: zlib, runs only     52 ms   3.41 MB
//   zlib level 1             124 ms   3.28 MB
//   zlib level 6             262 ms   3.26 MB
//   small: LZMA level 1      774 ms   2.76 MB
enum class Compression { fast, small, none };

// Atomic: the file is complete or not there. Throws WriteFailed.
void write_picture(vtkPolyData* picture, const std::filesystem::path& target,
                   const std::string& temporary_name, Compression compression);

}  // namespace shoal::vtk
