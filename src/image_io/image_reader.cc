#include "image_io/image_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "image_io/exr_reader.h"
#include "image_io/oiio.h"

namespace nacre {

Image ReadImage(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".exr") return ReadWithOiio(path);
  Image image = ReadExr(path);
  image.metadata["transfer"] = "linear";
  return image;
}

}  // namespace nacre
