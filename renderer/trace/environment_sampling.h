#pragma once
// Directions to an environment, by how much light comes from there.
//
// The map is bilinear between the middles of its pixels, so the cells of the density are the squares between them: the
// mean of a cell's corners, times its solid angle. Within a cell directions are uniform per steradian, so that the
// radiance is at most four times what the density expects.
// The mean radiance over the sphere is taken off the density: scattered rays find that as well. A part always stays, as
// none is scattered to below a triangle's horizon, where a smooth surface sees the sky.
// Source of the last but for that part: Karlík, Šik, Vévoda, Skřivan, Křivánek, MIS Compensation: Optimizing Sampling Techniques in
// Multiple Importance Sampling, 2019 (section 5.1).

#include <vector>

#include "renderer/scene/light.h"

namespace chiaro::renderer {

class EnvironmentSampling {
 public:
  // Keeps a reference to the light's map, which must outlive it.
  explicit EnvironmentSampling(const EnvironmentLight& light);

  // cd/m², that way.
  Vec3f radiance(Vec3f direction) const;

  struct Sample {
    Vec3f direction;  // unit
    Vec3f radiance;   // cd/m²
    float pdf = 0;    // per steradian
  };
  Sample sample(Vec2f u) const;
  // Density of sample(), per steradian.
  float pdf(Vec3f direction) const;

 private:
  // Rows of cells: row r lies between the middles of pixel rows r − 1 and r; the first and the last are half as high.
  float top_cosine(int row) const;
  float cell_luminance(int column, int row) const;
  void make_density(float taken_off);

  const EnvironmentMap& map_;
  float rotation_, intensity_;
  int columns_, rows_;
  std::vector<float> density_;     // per cell, per steradian
  std::vector<float> row_end_;     // cumulative, per row; the last is 1
  std::vector<float> column_end_;  // cumulative within its row, per cell; the last of a row is 1
};

}  // namespace chiaro::renderer
