// SPDX-License-Identifier: Apache-2.0
// image_io/jpeg_reader.cc: reads JPEG files with libjpeg-turbo.
#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

// In this order: the library's header needs FILE to be declared.
#include <jerror.h>
#include <jpeglib.h>

#include "base/error.h"
#include "image_io/c_file.h"
#include "image_io/format_readers.h"
#include "image_io/icc_profile.h"
#include "image_io/orientation.h"

namespace nacre {
namespace {

// A progressive file may have a scan for every bit of every coefficient, and a hostile file any
// number of scans, each of which decodes the whole image. libjpeg-turbo's own tests have the same
// limit.
constexpr int kMostScans = 500;

// The state of libjpeg and its callbacks. C types only, since errors leave libjpeg by longjmp.
struct Decoder {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf leave{};
  char message[JMSG_LENGTH_MAX] = {};
};

void OnError(j_common_ptr common) {
  auto* const decoder = static_cast<Decoder*>(common->client_data);
  common->err->format_message(common, decoder->message);
  std::longjmp(decoder->leave, 1);
}

// After a warning, the library continues with made-up pixels, so warnings are errors here, except
// those that do not affect pixels.
void OnMessage(j_common_ptr common, int level) {
  if (level >= 0) return;
  const int code = common->err->msg_code;
  if (code == JWRN_EXTRANEOUS_DATA || code == JWRN_ADOBE_XFORM || code == JWRN_JFIF_MAJOR) return;
  OnError(common);
}

void OnScan(j_common_ptr common) {
  auto* const decoder = static_cast<Decoder*>(common->client_data);
  if (decoder->jpeg.input_scan_number <= kMostScans) return;
  std::snprintf(decoder->message, sizeof decoder->message, "it has more than %d scans", kMostScans);
  std::longjmp(decoder->leave, 1);
}

struct DestroyDecoder {
  void operator()(Decoder* decoder) const {
    jpeg_destroy_decompress(&decoder->jpeg);
    delete decoder;
  }
};

// An open file.
class JpegFile {
 public:
  explicit JpegFile(const std::string& path) : path_(path), file_(OpenToRead(path)) {
    if (!file_) Fail(std::strerror(errno));
    decoder_->jpeg.err = jpeg_std_error(&decoder_->errors);
    decoder_->errors.error_exit = &OnError;
    decoder_->errors.emit_message = &OnMessage;
    decoder_->progress.progress_monitor = &OnScan;
    decoder_->jpeg.client_data = decoder_.get();
    Call([&](j_decompress_ptr jpeg) { ReadHeader(jpeg, decoder_.get(), file_.get()); });
  }

  const jpeg_decompress_struct& header() const { return decoder_->jpeg; }
  bool is_grey() const { return header().out_color_space == JCS_GRAYSCALE; }

  Orientation orientation() const {
    constexpr char kExif[] = "Exif\0";  // with the final zero
    for (auto marker = header().marker_list; marker != nullptr; marker = marker->next) {
      if (marker->marker != JPEG_APP0 + 1 || marker->data_length < sizeof kExif) continue;
      if (std::memcmp(marker->data, kExif, sizeof kExif) != 0) continue;
      return OrientationOfTag(
          ExifOrientation({marker->data + sizeof kExif, marker->data_length - sizeof kExif}));
    }
    return {};
  }

  // The embedded profile; empty if there is none.
  std::vector<uint8_t> profile() {
    JOCTET* bytes = nullptr;
    unsigned size = 0;
    Call([&](j_decompress_ptr jpeg) { jpeg_read_icc_profile(jpeg, &bytes, &size); });
    const std::unique_ptr<JOCTET, decltype(&std::free)> owner(bytes, &std::free);
    return {bytes, bytes + size};
  }

  // Starts to decode rows of `width` pixels with `components` samples each.
  void Start() {
    Call([](j_decompress_ptr jpeg) { jpeg_start_decompress(jpeg); });
  }
  void ReadRow(uint8_t* row) {
    Call([&](j_decompress_ptr jpeg) { jpeg_read_scanlines(jpeg, &row, 1); });
  }
  // To be called after the last row. Checks that the rest of the file is whole.
  void Finish() {
    Call([](j_decompress_ptr jpeg) { jpeg_finish_decompress(jpeg); });
  }

 private:
  // Calls body(), and throws if the library reports an error. libjpeg then leaves body() by
  // longjmp, which must not skip the destructor of a C++ object.
  template <class Body>
  void Call(const Body& body) {
    if (setjmp(decoder_->leave) != 0) FailWithMessage();
    body(&decoder_->jpeg);
  }

  static void ReadHeader(j_decompress_ptr jpeg, Decoder* decoder, std::FILE* file) {
    jpeg_create_decompress(jpeg);
    jpeg->client_data = decoder;
    jpeg->progress = &decoder->progress;
    jpeg_stdio_src(jpeg, file);
    constexpr unsigned kLongest = 0xffff;
    jpeg_save_markers(jpeg, JPEG_APP0 + 1, kLongest);
    jpeg_save_markers(jpeg, JPEG_APP0 + 2, kLongest);
    jpeg_read_header(jpeg, TRUE);
    const bool is_cmyk = jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK;
    jpeg->out_color_space = jpeg->jpeg_color_space == JCS_GRAYSCALE ? JCS_GRAYSCALE
                            : is_cmyk                               ? JCS_CMYK
                                                                    : JCS_RGB;
    jpeg_calc_output_dimensions(jpeg);
  }

  [[noreturn]] void Fail(const std::string& reason) const { FailToRead(path_, reason); }
  [[noreturn]] void FailWithMessage() const {
    if (decoder_->errors.msg_code == JERR_IMAGE_TOO_BIG) {
      throw Error(ExitCode::kBadInput, path_,
                  "cannot be read: it is wider or higher than " +
                      std::to_string(JPEG_MAX_DIMENSION) + " pixels",
                  "make it smaller");
    }
    Fail(decoder_->message);
  }

  std::string path_;
  CFile file_;
  std::unique_ptr<Decoder, DestroyDecoder> decoder_{new Decoder};
};

// Converts a row to values in [0, 1]. In CMYK files with Adobe's marker, 255 means no ink; in
// others, 0 means no ink. The colour is the light that each ink leaves, multiplied by what black
// leaves.
void ToFloats(const jpeg_decompress_struct& jpeg, const std::vector<uint8_t>& codes,
              std::vector<float>* values) {
  if (jpeg.out_color_space != JCS_CMYK) {
    std::ranges::transform(codes, values->begin(),
                           [](uint8_t code) { return static_cast<float>(code) / 255; });
    return;
  }
  const auto light = [&](uint8_t code) {
    return static_cast<float>(jpeg.saw_Adobe_marker ? code : 255 - code) / 255;
  };
  for (size_t x = 0; x < codes.size() / 4; ++x) {
    for (size_t c = 0; c < 3; ++c) {
      (*values)[3 * x + c] = light(codes[4 * x + c]) * light(codes[4 * x + 3]);
    }
  }
}

}  // namespace

ImageFile OpenJpeg(const std::string& path) {
  JpegFile jpeg(path);
  const Orientation orientation = jpeg.orientation();
  int width = static_cast<int>(jpeg.header().output_width);
  int height = static_cast<int>(jpeg.header().output_height);
  if (orientation.transpose) std::swap(width, height);
  std::map<std::string, std::string> metadata = {{"transfer", "display"}};
  if (const std::vector<uint8_t> embedded = jpeg.profile(); !embedded.empty()) {
    NoteIccProfile(embedded, &metadata);
  }
  ImageFile image =
      MakeImageFile(path, width, height, !jpeg.is_grey(), /*has_alpha=*/false, metadata);
  // Opens the file again for each reading, which decodes the rows from the first one on.
  image.read = [path, orientation, is_grey = jpeg.is_grey(), data = image.header.data](
                   const Window& region, std::span<const SampleTarget> targets) {
    JpegFile file(path);
    const RowPlacer placer(orientation, data, region, targets);
    CheckUnchanged(path,
                   placer.stored_width() == static_cast<int>(file.header().output_width) &&
                       placer.stored_height() == static_cast<int>(file.header().output_height) &&
                       is_grey == file.is_grey());
    const auto stored_width = static_cast<size_t>(placer.stored_width());
    const size_t channels = file.is_grey() ? 1 : 3;
    file.Start();
    std::vector<uint8_t> codes(stored_width * static_cast<size_t>(file.header().output_components));
    std::vector<float> values(stored_width * channels);
    for (int y = 0; y < placer.stored_height(); ++y) {
      file.ReadRow(codes.data());
      ToFloats(file.header(), codes, &values);
      placer.Place(y, values.data(), channels);
    }
    file.Finish();
  };
  return image;
}

}  // namespace nacre
