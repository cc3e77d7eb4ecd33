// SPDX-License-Identifier: Apache-2.0
#include "image_io/draw_text.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <utility>

#include <fribidi.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include "base/error.h"
#include "base/pool.h"
#include "base/printable.h"

namespace nacre {
namespace {

// Paths of the font on Debian, Fedora and Arch.
constexpr const char* kFontFiles[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                      "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                      "/usr/share/fonts/TTF/DejaVuSans.ttf"};

using Library = std::unique_ptr<FT_LibraryRec_, decltype(&FT_Done_FreeType)>;
using Face = std::unique_ptr<FT_FaceRec_, decltype(&FT_Done_Face)>;

// The font DejaVu Sans.
class Font {
 public:
  Font() {
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0)
      throw Error(ExitCode::kInternal, "labels", "FreeType cannot start");
    library_.reset(library);
    for (const char* const file : kFontFiles) {
      FT_Face face = nullptr;
      if (FT_New_Face(library, file, 0, &face) != 0) continue;
      face_.reset(face);
      return;
    }
    throw Error(ExitCode::kInternal, "labels", "the font DejaVu Sans is not installed",
                "Debian has it in the package fonts-dejavu-core");
  }

  void SetSize(int size_px) {
    if (size_px == size_px_) return;
    FT_Set_Pixel_Sizes(face_.get(), 0, static_cast<FT_UInt>(size_px));
    size_px_ = size_px;
  }

  // Renders the glyph of a character at the current size; valid until the next call.
  const FT_GlyphSlotRec_& Glyph(char32_t character) {
    if (FT_Load_Char(face_.get(), character, FT_LOAD_RENDER) != 0) {
      throw Error(ExitCode::kInternal, "labels", "the font DejaVu Sans is damaged");
    }
    return *face_->glyph;
  }

  // The advance of the glyph in pixels, without rendering it.
  int Advance(char32_t character) {
    if (FT_Load_Char(face_.get(), character, FT_LOAD_DEFAULT) != 0) return 0;
    return static_cast<int>(face_->glyph->advance.x >> 6);
  }

 private:
  Library library_{nullptr, &FT_Done_FreeType};
  Face face_{nullptr, &FT_Done_Face};
  int size_px_ = 0;
};

// The characters to draw for a text, from left to right: Hebrew and Arabic run from right to left,
// with numbers from left to right (Unicode's bidirectional algorithm), and Arabic letters take the
// form that joins them to their neighbours.
std::u32string CharactersOf(std::string_view text) {
  const std::string utf8 = Printable(text);
  std::vector<FriBidiChar> logical(utf8.size());
  logical.resize(static_cast<size_t>(
      fribidi_charset_to_unicode(FRIBIDI_CHAR_SET_UTF8, utf8.data(),
                                 static_cast<FriBidiStrIndex>(utf8.size()), logical.data())));
  constexpr FriBidiChar kFirstFromRight = 0x590;  // all scripts before it run from left to right
  if (std::ranges::all_of(logical, [](FriBidiChar c) { return c < kFirstFromRight; })) {
    return {logical.begin(), logical.end()};
  }
  std::vector<FriBidiChar> visual(logical.size() + 1);  // room for FriBidi's final 0
  FriBidiParType direction = FRIBIDI_PAR_ON;            // as the first letter has it
  if (fribidi_log2vis(logical.data(), static_cast<FriBidiStrIndex>(logical.size()), &direction,
                      visual.data(), nullptr, nullptr, nullptr) == 0) {
    throw std::bad_alloc();
  }
  visual.pop_back();
  std::erase(visual, FRIBIDI_CHAR_FILL);  // left where two letters were joined to one
  return {visual.begin(), visual.end()};
}

// Pixels [x0, x1) x [y0, y1) relative to the start of the baseline; y grows downwards.
struct Box {
  int x0 = INT_MAX, y0 = INT_MAX, x1 = INT_MIN, y1 = INT_MIN;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

// The coverage of each pixel by the strokes of a line, from 0 to 1.
struct Strokes {
  Box box;
  std::vector<float> coverage;

  int width() const { return box.x1 - box.x0; }
  size_t IndexOf(int x, int y) const {
    return static_cast<size_t>(y - box.y0) * static_cast<size_t>(width()) +
           static_cast<size_t>(x - box.x0);
  }
  float At(int x, int y) const { return coverage[IndexOf(x, y)]; }
  float& At(int x, int y) { return coverage[IndexOf(x, y)]; }
};

// Calls with_glyph(glyph, x) for each character of a line that starts at 0. Advances are whole
// pixels, without kerning, so that equal letters of small text look alike.
template <class WithGlyph>
void ForEachGlyph(const std::u32string& text, Font* font, const WithGlyph& with_glyph) {
  int x = 0;
  for (const char32_t character : text) {
    const FT_GlyphSlotRec_& glyph = font->Glyph(character);
    with_glyph(glyph, x);
    x += static_cast<int>(glyph.advance.x >> 6);
  }
}

Box BoundsOf(const std::u32string& text, Font* font) {
  Box box;
  ForEachGlyph(text, font, [&](const FT_GlyphSlotRec_& glyph, int x) {
    const int left = x + glyph.bitmap_left, top = -glyph.bitmap_top;
    box.x0 = std::min(box.x0, left);
    box.y0 = std::min(box.y0, top);
    // A space has no pixels, but an advance.
    box.x1 = std::max({box.x1, left + static_cast<int>(glyph.bitmap.width),
                       x + static_cast<int>(glyph.advance.x >> 6)});
    box.y1 = std::max(box.y1, top + static_cast<int>(glyph.bitmap.rows));
  });
  return box;
}

// `room`: the margin around the strokes in pixels.
Strokes DrawStrokes(const std::u32string& text, int room, Font* font) {
  Strokes strokes;
  strokes.box = BoundsOf(text, font);
  if (strokes.box.empty()) return strokes;
  strokes.box.x0 -= room;
  strokes.box.y0 -= room;
  strokes.box.x1 += room;
  strokes.box.y1 += room;
  strokes.coverage.resize(static_cast<size_t>(strokes.width()) *
                          static_cast<size_t>(strokes.box.y1 - strokes.box.y0));
  ForEachGlyph(text, font, [&](const FT_GlyphSlotRec_& glyph, int x) {
    const FT_Bitmap& bitmap = glyph.bitmap;
    for (int j = 0; j < static_cast<int>(bitmap.rows); ++j) {
      for (int i = 0; i < static_cast<int>(bitmap.width); ++i) {
        const float covered = static_cast<float>(bitmap.buffer[j * bitmap.pitch + i]) / 255;
        float& at = strokes.At(x + glyph.bitmap_left + i, j - glyph.bitmap_top);
        at = std::max(at, covered);
      }
    }
  });
  return strokes;
}

// Sets each pixel to the maximum within `radius` rows and columns (dilation).
Strokes Widen(const Strokes& strokes, int radius) {
  const Box& box = strokes.box;
  const auto widen = [&](const Strokes& from, int dx, int dy) {
    Strokes to = from;
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        for (int k = -radius; k <= radius; ++k) {
          const int i = std::clamp(x + k * dx, box.x0, box.x1 - 1);
          const int j = std::clamp(y + k * dy, box.y0, box.y1 - 1);
          to.At(x, y) = std::max(to.At(x, y), from.At(i, j));
        }
      }
    }
    return to;
  };
  return widen(widen(strokes, 1, 0), 0, 1);
}

// The vector from the start of the baseline to the point that the item places. Its y depends only
// on the font, so that labels in a row share a baseline.
struct Offset {
  int x, y;
};

Offset AlignmentOffset(const TextItem& item, const Box& text, Font* font) {
  const Box capital = BoundsOf(U"H", font), descender = BoundsOf(U"g", font);
  return {item.align_x == AlignX::kLeft    ? text.x0
          : item.align_x == AlignX::kRight ? text.x1
                                           : (text.x0 + text.x1) / 2,
          item.align_y == AlignY::kTop      ? capital.y0
          : item.align_y == AlignY::kBottom ? descender.y1
                                            : (capital.y0 + capital.y1) / 2};
}

void DrawItem(const TextItem& item, std::span<uint8_t> rgb8, int width, int height, Font* font) {
  font->SetSize(item.size_px);
  const std::u32string text = CharactersOf(item.text);
  const int outline = item.outline ? std::max(1, item.size_px / 12) : 0;
  Strokes strokes = DrawStrokes(text, outline, font);
  if (strokes.box.empty()) return;
  Strokes shade = outline > 0 ? Widen(strokes, outline) : strokes;
  Box bounds = strokes.box;
  bounds.x0 += outline;
  bounds.x1 -= outline;
  const Offset offset = AlignmentOffset(item, bounds, font);
  const int64_t left = int64_t{item.x} - offset.x, top = int64_t{item.y} - offset.y;
  for (int y = strokes.box.y0; y < strokes.box.y1; ++y) {
    for (int x = strokes.box.x0; x < strokes.box.x1; ++x) {
      const int64_t to_x = left + x, to_y = top + y;
      if (to_x < 0 || to_x >= width || to_y < 0 || to_y >= height) continue;
      uint8_t* const pixel = &rgb8[3 * static_cast<size_t>(to_y * width + to_x)];
      const float stroke = strokes.At(x, y), shown = 1 - shade.At(x, y);
      for (size_t c = 0; c < 3; ++c) {
        const float code =
            static_cast<float>(item.color[c]) * stroke + static_cast<float>(pixel[c]) * shown;
        pixel[c] = static_cast<uint8_t>(std::clamp(code + 0.5f, 0.0f, 255.0f));
      }
    }
  }
}

// Advance widths of the characters 32 to 126 of DejaVu Sans 2.37, in 1/2048 of the font size.
constexpr std::array<uint16_t, 95> kAdvances = {
    651,  821,  942,  1716, 1303, 1946, 1597, 563,  799,  799,  1024, 1716, 651,  739,  651,  690,
    1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 1303, 690,  690,  1716, 1716, 1716, 1087,
    2048, 1401, 1405, 1430, 1577, 1294, 1178, 1587, 1540, 604,  604,  1343, 1141, 1767, 1532, 1612,
    1235, 1612, 1423, 1300, 1251, 1499, 1401, 2025, 1403, 1251, 1403, 799,  690,  799,  1716, 1024,
    1024, 1255, 1300, 1126, 1300, 1260, 721,  1300, 1298, 569,  569,  1186, 569,  1995, 1298, 1253,
    1300, 1300, 842,  1067, 803,  1298, 1212, 1675, 1212, 1212, 1075, 1303, 690,  1303, 1716};
constexpr int kUnits = 2048;

// In the same units; `other` is returned for letters beyond ASCII.
int AdvanceOf(char first_byte, int other) {
  const auto code = static_cast<unsigned char>(first_byte);
  return code >= 32 && code < 127 ? kAdvances[code - 32u] : other;
}

bool IsFirstByte(char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) != 0x80u; }

int SizeDrawn(double size_px) { return std::max(static_cast<int>(std::lround(size_px)), 1); }

std::unique_ptr<Font> OpenFontIfInstalled() {
  try {
    return std::make_unique<Font>();
  } catch (const Error&) {
    return nullptr;  // DrawText will report it
  }
}

// The advance of a letter beyond ASCII, in pixels. If the font is not installed, the font size:
// sheets are also laid out for EXR files, into which no text is drawn.
int AdvanceBeyondAscii(char32_t character, int size_px) {
  struct Advances {  // of a font, of which one thread at a time may ask
    std::unique_ptr<Font> font = OpenFontIfInstalled();
    std::map<std::pair<int, char32_t>, int> known;  // FreeType is slow to ask
  };
  static Pool<Advances> pool;
  const Pool<Advances>::Borrowed advances = pool.Borrow();
  const auto [at, is_new] = advances->known.try_emplace({size_px, character}, size_px);
  if (is_new && advances->font) {
    advances->font->SetSize(size_px);
    at->second = advances->font->Advance(character);
  }
  return at->second;
}

}  // namespace

TextItem PlainText(const std::string& text, double x, double y, double size_px, AlignX align_x,
                   const Rgb8& color, AlignY align_y) {
  return {.text = text,
          .x = static_cast<int>(std::lround(x)),
          .y = static_cast<int>(std::lround(y)),
          .size_px = SizeDrawn(size_px),
          .align_x = align_x,
          .align_y = align_y,
          .color = color,
          .outline = false};
}

void DrawText(std::span<uint8_t> rgb8, int width, int height, const std::vector<TextItem>& items) {
  if (rgb8.size() != 3 * static_cast<size_t>(width) * static_cast<size_t>(height)) {
    throw Error(ExitCode::kInternal, "labels", "the buffer is not of the picture's size");
  }
  if (items.empty()) return;
  Font font;
  for (const TextItem& item : items) DrawItem(item, rgb8, width, height, &font);
}

double TextWidth(std::string_view text, double size_px) {
  double units = 0;
  for (const char c : text) {
    if (IsFirstByte(c)) units += AdvanceOf(c, kAdvances['0' - 32]);
  }
  return units / kUnits * size_px;
}

double DrawnWidth(std::string_view text, double size_px) {
  const int size = SizeDrawn(size_px);
  int width = 0;
  for (const char32_t character : CharactersOf(text)) {
    if (character >= 127) {
      width += AdvanceBeyondAscii(character, size);
      continue;
    }
    // FreeType scales to 1/64 of a pixel, then rounds to whole pixels.
    const int in_64ths = (2 * AdvanceOf(static_cast<char>(character), kUnits) * size + 32) / 64;
    width += (in_64ths + 32) / 64;
  }
  return width;
}

}  // namespace nacre
