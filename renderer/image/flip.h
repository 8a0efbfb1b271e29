#pragma once
// FLIP: the difference that somebody sees who flips between two pictures.
// Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, FLIP: A Difference Evaluator for
// Alternating Images, 2020.

#include "renderer/core/control.h"
#include "renderer/image/image.h"

namespace chiaro::renderer {

// Pixels per degree of visual angle, 0.7 m in front of 3840 pixels of 0.7 m: what the authors' figures are for.
inline constexpr double kPixelsPerDegree = 67.0206;

// Of each pixel the difference, 0 (none) to 1, as an image of one channel, "FLIP". The pictures are R, G, B on the sRGB
// curve, 0 to 1, of one size; what is beyond is clamped, NaN counts as 0.
Image flip(const Image& a, const Image& b, double pixels_per_degree = kPixelsPerDegree, const Control& control = {});

// The same for linear R, G, B.
Image flip_of_linear(const Image& a, const Image& b, double pixels_per_degree = kPixelsPerDegree,
                     const Control& control = {});

}  // namespace chiaro::renderer
