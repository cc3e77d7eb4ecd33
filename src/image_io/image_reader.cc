#include "image_io/image_reader.h"

#include "base/path.h"
#include "image_io/exr_reader.h"
#include "image_io/oiio.h"

namespace nacre {

Image ReadImage(const std::string& path) {
  if (!HasExtension(path, ".exr")) return ReadWithOiio(path);
  Image image = ReadExr(path);
  image.metadata["transfer"] = "linear";
  return image;
}

}  // namespace nacre
