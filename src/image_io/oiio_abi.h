// SPDX-License-Identifier: Apache-2.0
// image_io/oiio_abi.h: what the module nacre_oiio offers, in plain C types.
//
// The module is the only thing that links OpenImageIO, whose 261 libraries take 0.2 s to load; it
// is opened when first needed. Both sides are built together.
#pragma once

#include <cstdint>

extern "C" {

// An image file that is open. Close with NacreOiioClose.
struct NacreOiioFile {
  void* input;
  int32_t data_window[4];     // x0, y0, x1, y1: x1 and y1 are excluded
  int32_t display_window[4];  // likewise
  int32_t channel_count;
  int32_t integer_samples;  // 1: the file's are integers, here divided by their maximum
  int32_t half_samples;     // 1: the file's are 16-bit floats
  int32_t orientation;      // TIFF's and EXIF's number: how the rows lie in the image that is seen
  int32_t band_rows;        // rows that are best read together
  char* channel_names;      // each ended by a NUL
  char* attributes;         // name NUL value NUL ...; an empty name ends them
};

// All return null, or the reason for failing, valid until the thread's next call. None lets an
// exception out. Images with tiles of more than max_samples samples are refused.
const char* NacreOiioOpen(const char* path, uint64_t max_samples, NacreOiioFile* file);
// Rows y0 to y1 - 1 as they are stored, from 0 on, the channels of a pixel together. In ascending
// order; y0 is a multiple of band_rows, and y1 y0 + band_rows or the last row's end.
const char* NacreOiioReadRows(NacreOiioFile* file, int32_t y0, int32_t y1, float* values);

void NacreOiioClose(NacreOiioFile* file);

}  // extern "C"
