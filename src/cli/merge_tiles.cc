// SPDX-License-Identifier: Apache-2.0
#include "cli/merge_tiles.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "base/numbers.h"
#include "cli/progress.h"
#include "image_io/exr_checksum.h"
#include "output/metadata.h"

namespace nacre {
namespace {

constexpr char kSceneHash[] = "nacre:sceneHash";

struct HeaderOfTile {
  std::string path;
  ExrBandHeader band;

  const ExrHeader& header() const { return band.header; }
};

// Attributes that are compared first, with a hint how to fix a difference; the others are compared
// after them by name. The scene's hash comes after the settings, which it covers, too: otherwise it
// would hide which setting differs.
struct KnownAttribute {
  const char* name;
  const char* hint;
};
constexpr KnownAttribute kKnown[] = {
    {"nacre:version", "render all tiles with one build of nacre"},
    {"nacre:commit", "render all tiles with one build of nacre"},
    {"nacre:target", "the bits depend on it: pin one for all tiles, e.g. --target avx2"},
    {"nacre:settings", "render all tiles with the same options"},
    {"nacre:maxError", "render all tiles with the same --max-error"},
    {"nacre:maxSamples", "render all tiles with the same --spp"},
    {kSceneHash, "the scene changed in between: render the older tiles again"},
    {kRenderTimeAttribute, "render all tiles with --reproducible, or none"},
};

std::string TextOf(const ExrHeader& header, const std::string& name) {
  const auto found = header.attributes.find(name);
  if (found == header.attributes.end()) return "none";
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, found->second);
}

[[noreturn]] void ThrowDifference(const HeaderOfTile& a, const HeaderOfTile& b,
                                  const std::string& what, const std::string& of_a,
                                  const std::string& of_b, const std::string& hint) {
  throw Error(ExitCode::kBadInput, a.path + ", " + b.path,
              fmt::format("differ in {}: {} and {}", what, of_a, of_b), hint);
}

void CheckAttribute(const HeaderOfTile& a, const HeaderOfTile& b, const std::string& name,
                    const std::string& hint) {
  const std::string of_a = TextOf(a.header(), name);
  const std::string of_b = TextOf(b.header(), name);
  // The render time of each tile differs, but either all tiles have one or none.
  const bool same =
      name == kRenderTimeAttribute ? (of_a == "none") == (of_b == "none") : of_a == of_b;
  if (!same) ThrowDifference(a, b, name, of_a, of_b, hint);
}

std::string ChannelNames(const ExrHeader& header) {
  std::string names;
  for (const ExrChannel& channel : header.channels) {
    names +=
        fmt::format("{}{}:{}", names.empty() ? "" : " ", channel.name, PixelTypeName(channel.type));
  }
  return names;
}

// Throws unless a and b are tiles of the same picture.
void CheckSamePicture(const HeaderOfTile& a, const HeaderOfTile& b) {
  const auto compare = [&](const char* what, const std::string& of_a, const std::string& of_b,
                           const char* hint) {
    if (of_a != of_b) ThrowDifference(a, b, what, of_a, of_b, hint);
  };
  const auto size = [](const HeaderOfTile& tile) {
    const Window& frame = tile.header().display;
    return fmt::format("{}x{}", frame.width(), frame.height());
  };
  compare("size", size(a), size(b), "they are tiles of different pictures");
  for (const KnownAttribute& known : kKnown) CheckAttribute(a, b, known.name, known.hint);
  std::set<std::string> others;
  for (const HeaderOfTile* tile : {&a, &b}) {
    for (const auto& [name, value] : tile->header().attributes) others.insert(name);
  }
  others.erase(kTileAttribute);
  for (const std::string& name : others) CheckAttribute(a, b, name, "");
  compare("layers", ChannelNames(a.header()), ChannelNames(b.header()),
          "render all tiles with the same --layers and --depth");
  compare("compression", CompressionName(a.band.compression), CompressionName(b.band.compression),
          "render all tiles with the same --compression");
}

// Throws unless the tile can be part of any picture.
void CheckShape(const HeaderOfTile& tile) {
  const Window& frame = tile.header().display;
  const Window& data = tile.header().data;
  if (!tile.header().attributes.contains(kSceneHash)) {
    throw Error(ExitCode::kBadInput, tile.path,
                fmt::format("is not a tile that nacre rendered: its header has no {}", kSceneHash),
                "nacre render SCENE -o tile.exr --tile i/N");
  }
  if (data.x0 != frame.x0 || data.x1 != frame.x1 || Intersect(data, frame) != data) {
    throw Error(ExitCode::kBadInput, tile.path, "does not hold whole rows of the picture",
                "render tiles with --tile i/N");
  }
  const int chunk_rows = RowsPerChunk(tile.band.compression);
  if ((data.y0 - frame.y0) % chunk_rows != 0) {
    throw Error(ExitCode::kBadInput, tile.path,
                fmt::format("begins at row {}, which is not a multiple of the {} rows that {} "
                            "compresses together",
                            data.y0, chunk_rows, CompressionName(tile.band.compression)),
                "render tiles with --tile i/N");
  }
}

std::string RowsText(int first, int end) {
  return end - first == 1 ? fmt::format("row {}", first)
                          : fmt::format("rows {} to {}", first, end - 1);
}

struct TileNumber {
  int index, count;
};

// The tile "i/N" that the header names; nullopt if it names none that --tile could make. A tile has
// at least one row of the picture.
std::optional<TileNumber> NumberOf(const HeaderOfTile& tile) {
  const auto numbers = ParseIntegers(TextOf(tile.header(), kTileAttribute), '/', 2);
  if (!numbers) return std::nullopt;
  const TileNumber number{numbers->front(), numbers->back()};
  const bool is_tile = number.index >= 0 && number.index < number.count &&
                       number.count <= tile.header().display.height();
  return is_tile ? std::optional(number) : std::nullopt;
}

// Hints how to render the rows that no tile has: by naming the missing tiles i/N, if all tiles have
// the same N.
std::string HintForGap(const std::vector<HeaderOfTile>& tiles) {
  constexpr size_t kMostNamed = 20;
  const std::string general = "render what is missing with --tile";
  std::set<int> there;
  int count = 0;
  for (const HeaderOfTile& tile : tiles) {
    const std::optional<TileNumber> number = NumberOf(tile);
    if (!number || (count != 0 && number->count != count)) return general;
    count = number->count;
    there.insert(number->index);
  }
  std::vector<std::string> missing;
  for (int i = 0; i < count; ++i) {
    if (!there.contains(i)) missing.push_back(fmt::format("{}/{}", i, count));
  }
  if (missing.empty()) return general;
  const size_t others = missing.size() - std::min(missing.size(), kMostNamed);
  missing.resize(missing.size() - others);
  return fmt::format("render what is missing: --tile {}{}", fmt::join(missing, ", "),
                     others == 0 ? "" : fmt::format(" and {} more", others));
}

// Throws unless the tiles, which are sorted, hold every row exactly once. Reports all errors.
void CheckCover(const std::vector<HeaderOfTile>& tiles) {
  const Window& frame = tiles[0].header().display;
  std::vector<Fault> faults;
  bool has_gap = false;
  const auto gap = [&](const std::string& files, int first, int end, const char* place) {
    faults.push_back({files, fmt::format("{} {} in no tile", RowsText(first, end), place),
                      std::exchange(has_gap, true) ? "" : HintForGap(tiles)});
  };
  const int top = tiles.front().header().data.y0;
  if (top > frame.y0) gap(tiles.front().path, frame.y0, top, "above it are");
  int end = tiles[0].header().data.y1;
  size_t lowest = 0;  // the tile whose rows end at `end`
  for (size_t i = 1; i < tiles.size(); ++i) {
    const Window& data = tiles[i].header().data;
    const std::string pair = tiles[lowest].path + ", " + tiles[i].path;
    if (data.y0 > end) gap(pair, end, data.y0, "between them are");
    if (data.y0 < end) {
      faults.push_back({pair,
                        fmt::format("both hold {}", RowsText(data.y0, std::min(end, data.y1))),
                        "leave one of them out"});
    }
    if (data.y1 < end) continue;
    end = data.y1;
    lowest = i;
  }
  if (end < frame.y1) gap(tiles[lowest].path, end, frame.y1, "below it are");
  if (!faults.empty()) throw Error(ExitCode::kBadInput, std::move(faults));
}

// Reads the header of a file and checks that the file is intact: by its checksum, or, if it has
// none, by decoding all of it; then it is added to `unproven`.
ExrBandHeader ReadProvenHeader(const std::string& path, std::vector<std::string>* unproven) {
  const ExrChecksum checksum = CheckExrChecksum(path);
  if (checksum == ExrChecksum::kWrong) {
    throw Error(ExitCode::kBadInput, path,
                "is damaged: its bytes are not those that its checksum was made of",
                "render this tile again");
  }
  ExrBandReader reader(path);
  ExrBandHeader header = reader.ReadHeader();
  if (checksum == ExrChecksum::kNone) {
    reader.DecodeAll();
    unproven->push_back(path);
  }
  return header;
}

}  // namespace

TilesOfPicture FindTiles(const std::vector<std::string>& paths) {
  TilesOfPicture picture;
  std::vector<HeaderOfTile> tiles;
  tiles.reserve(paths.size());
  std::vector<Fault> faults;  // collected from all damaged tiles, so that the user can render them
                              // again at once
  for (const std::string& path : paths) {
    ThrowIfStopped();
    try {
      tiles.push_back({path, ReadProvenHeader(path, &picture.unproven)});
    } catch (const Error& error) {
      if (error.code() != ExitCode::kBadInput) throw;
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  }
  if (!faults.empty()) throw Error(ExitCode::kBadInput, std::move(faults));
  for (const HeaderOfTile& tile : tiles) {
    CheckShape(tile);
    CheckSamePicture(tiles.front(), tile);
  }
  std::ranges::stable_sort(tiles, {},
                           [](const HeaderOfTile& tile) { return tile.header().data.y0; });
  CheckCover(tiles);

  picture.whole = tiles.front().band;
  picture.whole.header.data = picture.whole.header.display;
  auto& attributes = picture.whole.header.attributes;
  attributes.erase(kTileAttribute);
  double seconds = 0;
  for (const HeaderOfTile& tile : tiles) {
    picture.tiles.push_back({tile.path, tile.header().data});
    const auto time = tile.header().attributes.find(kRenderTimeAttribute);
    if (time == tile.header().attributes.end()) continue;
    if (const float* real = std::get_if<float>(&time->second)) seconds += *real;
  }
  if (const auto time = attributes.find(kRenderTimeAttribute); time != attributes.end()) {
    time->second = static_cast<float>(seconds);
  }
  return picture;
}

}  // namespace nacre
