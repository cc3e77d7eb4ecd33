// SPDX-License-Identifier: Apache-2.0
#include "image_io/jpeg_writer.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <memory>

// In this order: the library's header needs FILE to be declared.
#include <jpeglib.h>

#include "base/error.h"

namespace nacre {
namespace {

// The state of libjpeg and its callbacks. C types only, since errors leave libjpeg by longjmp.
struct Encoder {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  std::jmp_buf leave{};
  char message[JMSG_LENGTH_MAX] = {};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

void OnEncoderError(j_common_ptr common) {
  auto* const encoder = static_cast<Encoder*>(common->client_data);
  common->err->format_message(common, encoder->message);
  std::longjmp(encoder->leave, 1);
}

struct DestroyEncoder {
  void operator()(Encoder* encoder) const {
    jpeg_destroy_compress(&encoder->jpeg);
    std::free(encoder->bytes);
    delete encoder;
  }
};

// Returns false, with a message, if the library fails. It may leave by longjmp, which must not skip
// the destructor of a C++ object.
bool TryEncode(const uint8_t* rgb8, unsigned width, unsigned height, int quality,
               Encoder* encoder) {
  if (setjmp(encoder->leave) != 0) return false;
  jpeg_compress_struct& jpeg = encoder->jpeg;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &encoder->bytes, &encoder->size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  for (int c = 0; c < 3; ++c) jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
  jpeg_start_compress(&jpeg, TRUE);
  while (jpeg.next_scanline < jpeg.image_height) {
    auto* row = const_cast<JSAMPROW>(rgb8 + size_t{3} * width * jpeg.next_scanline);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

}  // namespace

std::vector<uint8_t> EncodeJpeg(const Rgb8Picture& picture, int quality) {
  const std::unique_ptr<Encoder, DestroyEncoder> encoder(new Encoder);
  encoder->jpeg.err = jpeg_std_error(&encoder->errors);
  encoder->errors.error_exit = &OnEncoderError;
  encoder->jpeg.client_data = encoder.get();
  if (!TryEncode(picture.rgb8.data(), static_cast<unsigned>(picture.width),
                 static_cast<unsigned>(picture.height), quality, encoder.get())) {
    throw Error(ExitCode::kInternal, "JPEG", encoder->message);
  }
  return {encoder->bytes, encoder->bytes + encoder->size};
}

}  // namespace nacre
