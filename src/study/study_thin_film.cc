// SPDX-License-Identifier: Apache-2.0
// study/study_thin_film.cc: the colours of thin films, and what approximations make of them.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "brdf/fresnel.h"
#include "brdf/thin_film.h"
#include "brdf/thin_film_spectrum.h"
#include "report/plot.h"
#include "study/picture.h"
#include "study/study.h"

namespace nacre {
namespace {

const Rgb kGoldF0(0.929, 0.788, 0.374);  // OpenPBR's example

// Gold's index, by what it is guessed from.
struct GuessedIndex {
  const char* name;
  RgbSubstrate gold;
};

std::vector<GuessedIndex> GuessesOfGold() {
  std::vector<GuessedIndex> guesses = {
      {"gulbrandsen_f82", {}}, {"gulbrandsen_tint", {}}, {"real_index", {}}};
  for (size_t c = 0; c < 3; ++c) {
    const double r = kGoldF0[static_cast<int>(c)];
    guesses[0].gold[c] = GulbrandsenIndex(r, FresnelF82(1.0 / 7, 6.0 / 7, r, 0.0));
    guesses[1].gold[c] = GulbrandsenIndex(r, 1);
    guesses[2].gold[c] = RealIndex(r);
  }
  return guesses;
}

// A surface below a film of index 1.4.
struct FilmedSurface {
  const char* name;
  Rgb f0;  // without the film
  RgbSubstrate substrate;
  double brightest;  // reflectance that is shown as white
};

std::vector<FilmedSurface> FilmedSurfaces() {
  const Rgb glass(FresnelF0(1.5, 0.0));
  return {{"dielectric of index 1.5", glass, SameSubstrate({1.5, 0}), 0.15},
          {"gold", kGoldF0, GuessesOfGold()[0].gold, 1}};
}

struct FilmForm {
  const char* name;
  Rgb (*reflectance)(const ThinFilm& film, const FilmedSurface& surface, double cosine);
};

// The first is the truth.
constexpr FilmForm kForms[] = {
    {"spectral",
     [](const ThinFilm& film, const FilmedSurface& surface, double cosine) {
       return Rgb(1) - SpectralLoss(film, surface.substrate, cosine);
     }},
    {"belcour_barla",
     [](const ThinFilm& film, const FilmedSurface& surface, double cosine) {
       return Rgb(1) - BelcourBarlaLoss(film, surface.substrate, cosine);
     }},
    {"lines",
     [](const ThinFilm& film, const FilmedSurface& surface, double cosine) {
       return Rgb(1) - ThreeLineLoss(film, surface.substrate, cosine);
     }},
    {"glTF", [](const ThinFilm& film, const FilmedSurface& surface,
                double cosine) { return GltfIridescence(film, surface.f0, cosine); }},
};

constexpr double kThickest = 1000;  // nm
constexpr double kFilmIndex = 1.4;

Rgb FilmReflectance(const FilmForm& form, const FilmedSurface& surface, double thickness,
                    double cosine) {
  return form.reflectance({1, kFilmIndex, thickness}, surface, cosine);
}

// Thickness from 0 at the left to kThickest, the angle from 0 at the bottom to 90 degrees.
Rgb8Picture FilmPane(const FilmForm& form, const FilmedSurface& surface) {
  constexpr int kWidth = 300, kHeight = 100;
  Image image;
  image.display = image.data = {0, 0, kWidth, kHeight};
  for (const char* name : {"R", "G", "B"}) image.channels.push_back({.name = name, .samples = {}});
  for (int y = 0; y < kHeight; ++y) {
    const double cosine = std::cos(M_PI / 2 * (kHeight - y - 0.5) / kHeight);
    for (int x = 0; x < kWidth; ++x) {
      const Rgb color = FilmReflectance(form, surface, kThickest * (x + 0.5) / kWidth, cosine) /
                        surface.brightest;
      for (int c = 0; c < 3; ++c) {
        image.channels[static_cast<size_t>(c)].samples.push_back(static_cast<float>(color[c]));
      }
    }
  }
  return ShowImage(image, kClipped);
}

Plot FilmPlot(const FilmedSurface& surface, int channel, const char* channel_name) {
  Plot plot;
  plot.title = fmt::format("{}, {}", surface.name, channel_name);
  plot.x = {.label = "thickness (nm)", .low = 0, .high = kThickest, .step = 250};
  plot.y = {.label = "reflectance along the normal"};
  for (const FilmForm& form : kForms) {
    plot.curves.push_back(MakeCurve(form.name, Steps(0, kThickest, 200), [&](double thickness) {
      return FilmReflectance(form, surface, thickness, 1)[channel];
    }));
  }
  return plot;
}

struct FilmError {
  double rms = 0, largest = 0;
};

// The difference of two reflectances over thicknesses of 25 nm to kThickest, angles of 0 to 85
// degrees, and the channels. Each is a function of film and cosine.
template <class Got, class Truth>
FilmError MeasureFilm(const Got& got, const Truth& truth) {
  FilmError error;
  int count = 0;
  for (const double thickness : Steps(25, kThickest, 39)) {
    for (const double degrees : Steps(0, 85, 17)) {
      const ThinFilm film{1, kFilmIndex, thickness};
      const double cosine = std::cos(degrees * M_PI / 180);
      const Rgb difference = got(film, cosine) - truth(film, cosine);
      for (int c = 0; c < 3; ++c) {
        error.largest = std::max(error.largest, std::abs(difference[c]));
        error.rms += difference[c] * difference[c];
        ++count;
      }
    }
  }
  error.rms = std::sqrt(error.rms / count);
  return error;
}

}  // namespace

StudyResult StudyThinFilm(const StudyProgress& progress) {
  StudyResult result;
  PaneSheet sheet;
  const std::vector<FilmedSurface> surfaces = FilmedSurfaces();
  for (const FilmedSurface& surface : surfaces) sheet.columns.emplace_back(surface.name);
  for (const FilmForm& form : kForms) {
    sheet.rows.emplace_back(form.name);
    for (const FilmedSurface& surface : surfaces) {
      sheet.panes.push_back(FilmPane(form, surface));
      progress(0.1 * static_cast<double>(sheet.panes.size()));
    }
  }
  result.pictures.push_back(MakeStudyPicture(
      "films",
      "Reflectance of films of index 1.4 that are 0 to 1000 nm thick, from left to right, seen "
      "along the normal at the bottom and along the surface at the top.",
      sheet));
  std::string errors;
  for (const FilmedSurface& surface : surfaces) {
    for (const FilmForm& form : kForms) {
      if (&form == kForms) continue;
      const auto by = [&](const FilmForm& f) {
        return [&](const ThinFilm& film, double cosine) {
          return f.reflectance(film, surface, cosine);
        };
      };
      const FilmError error = MeasureFilm(by(form), by(kForms[0]));
      const std::string name = fmt::format("{}, {}", surface.name, form.name);
      result.numbers.push_back({name + ": rms error of the reflectance", error.rms, ""});
      result.numbers.push_back({name + ": largest error", error.largest, ""});
      errors += fmt::format("- {}: {:.3f}, at most {:.2f}\n", name, error.rms, error.largest);
    }
  }
  progress(0.9);
  std::string guesses;
  const auto by_guess = [](const GuessedIndex& guess) {
    return [&](const ThinFilm& film, double cosine) {
      return Rgb(1) - SpectralLoss(film, guess.gold, cosine);
    };
  };
  const std::vector<GuessedIndex> golds = GuessesOfGold();
  for (const GuessedIndex& guess : golds) {
    const double blue = by_guess(guess)({1, kFilmIndex, 400}, 1).z;
    const FilmError error = MeasureFilm(by_guess(guess), by_guess(golds[0]));
    const std::string name = fmt::format("gold of index {}", guess.name);
    result.numbers.push_back({name + ", film of 400 nm: blue along the normal", blue, ""});
    result.numbers.push_back({name + ": rms difference from gulbrandsen_f82", error.rms, ""});
    guesses += fmt::format("- {}: {:.3f}; blue {:.3f}\n", guess.name, error.rms, blue);
  }
  for (const FilmedSurface& surface : surfaces) {
    result.figures.push_back({surface.substrate[0].k > 0 ? "gold" : "dielectric",
                              "The spectral curve is the truth: Airy's sum, integrated.",
                              MakeRow({FilmPlot(surface, 0, "red"), FilmPlot(surface, 1, "green"),
                                       FilmPlot(surface, 2, "blue")})});
  }
  result.answer = fmt::format(
      "The truth is Airy's sum of all reflections in the film, integrated over the visible "
      "spectrum and turned into Rec. 709. Rms errors of the reflectance over thicknesses of 25 to "
      "1000 nm, angles of 0 to 85 degrees and three channels (bare, the dielectric reflects 0.04 "
      "along its normal, gold 0.37 to 0.93):\n\n{}\n"
      "Three lines show colours that thick films do not have: each line keeps its fringes at every "
      "thickness, while those of a spectrum wash out. MaterialX takes two terms of Belcour and "
      "Barla's series, of which metals need more. glTF's formula has no complex index: it takes a "
      "metal for a dielectric.\n\n"
      "A metal has no index in these models: it is guessed from the metal's colours "
      "(`film_metal`). Rms differences of the spectral reflectance of gold from that of the first "
      "guess, and blue "
      "along the normal under a film of 400 nm:\n\n{}",
      errors, guesses);
  progress(1);
  return result;
}

}  // namespace nacre
