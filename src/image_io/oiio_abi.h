// SPDX-License-Identifier: Apache-2.0
// image_io/oiio_abi.h: the interface of the module nacre_oiio, in plain C types.
//
// Only the module links OpenImageIO, whose 261 libraries take 0.2 s to load; it is opened when it
// is first needed. Both sides are built together.
#pragma once

#include <cstdint>

extern "C" {

// An open image file. To be closed with NacreOiioClose.
struct NacreOiioFile {
  void* input;
  int32_t data_window[4];     // x0, y0, x1, y1; x1 and y1 are exclusive
  int32_t display_window[4];  // x0, y0, x1, y1, as for data_window
  int32_t channel_count;
  int32_t integer_samples;  // 1: the file has integers, which are divided here by their maximum
  int32_t half_samples;     // 1: the file has 16-bit floats
  int32_t orientation;      // the number that TIFF and EXIF have for the orientation of the rows
  int32_t band_rows;        // the number of rows to read together for speed
  char* channel_names;      // NUL-terminated, one after the other
  char* attributes;         // name NUL value NUL ...; an empty name ends them
};

// All functions return null, or the reason for failure, which is valid until the thread's next
// call. None throws. Images with tiles of more than max_samples samples are refused.
const char* NacreOiioOpen(const char* path, uint64_t max_samples, NacreOiioFile* file);
// Reads the rows y0 to y1 - 1 as stored, counted from 0, with interleaved channels. Calls must be
// in ascending order; y0 must be a multiple of band_rows, and y1 must be y0 + band_rows or the
// number of rows, whichever is less.
const char* NacreOiioReadRows(NacreOiioFile* file, int32_t y0, int32_t y1, float* values);

void NacreOiioClose(NacreOiioFile* file);

}  // extern "C"
