// SPDX-License-Identifier: Apache-2.0
#include "image_io/exr_chunk.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>

#include "base/error.h"
#include "base/pool.h"
#include "image_io/deflate.h"
#include "image_io/exr_types.h"

namespace nacre {

std::vector<uint8_t> StoreWords(std::span<const uint16_t> words) {
  const auto* const bytes = reinterpret_cast<const uint8_t*>(words.data());
  return {bytes, bytes + words.size_bytes()};
}

std::vector<uint8_t> CompressZip(std::span<const uint16_t> words, int deflate_level) {
  static Pool<std::vector<uint8_t>> buffers;
  const auto predicted = buffers.Borrow();
  const size_t size = words.size_bytes();
  if (predicted->size() < size) predicted->resize(size);
  SplitAndPredict(words.data(), words.size(), predicted->data());
  std::vector<uint8_t> chunk =
      Deflate({predicted->data(), size}, DeflateForm::kZlib, deflate_level);
  if (chunk.size() < size) return chunk;
  return StoreWords(words);
}

// OpenEXR's C++ library compresses only whole files, and version 3.1 of its C library cannot encode
// DWAA. So this writes the chunk as a small file in memory, and reads it back from there.
std::vector<uint8_t> CompressByLibrary(const ExrLayout& layout, Compression compression,
                                       std::span<const uint16_t> words) {
  const int rows = static_cast<int>(words.size() / layout.row_words);
  Imf::Header header(static_cast<int>(layout.width), rows, 1.0f, Imath::V2f(0.0f), 1.0f,
                     Imf::INCREASING_Y,
                     static_cast<Imf::Compression>(CompressionNumber(compression)));
  Imf::FrameBuffer frame;
  auto* place = reinterpret_cast<char*>(const_cast<uint16_t*>(words.data()));  // only read
  for (const ExrChannel& channel : layout.channels) {
    const Imf::PixelType type = ToImfType(channel.type);
    const size_t sample_bytes = 2 * SampleWords(channel.type);
    header.channels().insert(channel.name, Imf::Channel(type));
    frame.insert(channel.name, Imf::Slice(type, place, sample_bytes, 2 * layout.row_words));
    place += layout.width * sample_bytes;
  }
  try {
    constexpr int kNoThreads = 0;
    Imf::StdOSStream written;
    {
      Imf::OutputFile file(written, header, kNoThreads);
      file.setFrameBuffer(frame);
      file.writePixels(rows);
    }
    Imf::StdISStream source;
    source.str(written.str());
    Imf::InputFile file(source, kNoThreads);
    const char* chunk = nullptr;
    int size = 0;
    file.rawPixelData(0, chunk, size);
    return {chunk, chunk + size};
  } catch (const std::exception& error) {
    throw Error(ExitCode::kInternal, "OpenEXR", error.what());
  }
}

}  // namespace nacre
