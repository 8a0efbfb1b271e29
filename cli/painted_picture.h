#pragma once

#include <string>
#include <vector>

#include "cli/view_options.h"
#include "renderer/core/vec.h"

namespace chiaro::cli {

// How the values of painted pictures are understood.
struct PictureEncoding {
  std::string space;  // of the config, for all pictures; empty: by the kind of file
  ViewChoice view;    // that display-referred pictures were painted under, at its exposure
  bool keep_white = false;
};

// Colours of an image file that somebody painted.
struct PaintedPicture {
  int width = 0, height = 0;
  std::vector<renderer::Vec3f> pixels;  // scene-linear Rec.709, cd/m², rows from the top
  std::vector<float> weight;            // per pixel: its alpha
  std::string encoding;                 // how its values were understood, in words
  renderer::Vec3f white;                // what its white is, cd/m²
  std::size_t white_pixels = 0;         // of display-referred pictures: at white in a channel
};

// Files of floats hold scene-linear values, in the space that they name, of whole numbers what the encoding's display
// and view show, unless the encoding names a space. The exposure is undone. White pixels of a display-referred picture
// tell only that at least so much is wanted: their weight is 0 unless kept. Colours that the file has multiplied by its
// alpha are divided by it first. Error where the file has no colours.
PaintedPicture load_painted_picture(const std::string& file, const PictureEncoding& encoding);

// Luminance, as the file stores it, times alpha of each pixel, 0 to 1. Error where its size is another.
std::vector<float> load_mask(const std::string& file, int width, int height);

}  // namespace chiaro::cli
