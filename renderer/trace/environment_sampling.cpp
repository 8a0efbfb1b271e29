#include "renderer/trace/environment_sampling.h"

#include "renderer/core/control.h"

namespace chiaro::renderer {
namespace {

// Where in a cumulative distribution `u` falls, and how far into that step, 0 to 1.
struct Step {
  int index;
  float within;
};

Step find_step(const float* end, int count, float u) {
  const int index = std::min(int(std::upper_bound(end, end + count, u) - end), count - 1);
  const float begin = index > 0 ? end[index - 1] : 0;
  return {index, std::clamp((u - begin) / (end[index] - begin), 0.0F, 1.0F)};
}

// Sums of the weights, as parts of the whole. The last is 1 from the last weight above zero on.
double accumulate(const double* weights, int count, float* end) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += weights[i];
  double part = 0;
  for (int i = 0; i < count; ++i) {
    part += weights[i];
    end[i] = sum > 0 ? float(part / sum) : 1.0F;
  }
  return sum;
}

}  // namespace

EnvironmentSampling::EnvironmentSampling(const EnvironmentLight& light)
    : map_(*light.map),
      rotation_(light.rotation),
      intensity_(light.intensity),
      columns_(map_.width),
      rows_(map_.height + 1),
      density_(std::size_t(columns_) * std::size_t(rows_)),
      row_end_(std::size_t(rows_)),
      column_end_(density_.size()) {
  double mean = 0;
  for (int row = 0; row < rows_; ++row) {
    double sum = 0;
    for (int column = 0; column < columns_; ++column) sum += double(cell_luminance(column, row));
    mean += sum / columns_ * double(top_cosine(row) - top_cosine(row + 1)) / 2;
  }
  make_density(float(mean));
}

float EnvironmentSampling::top_cosine(int row) const {
  const float v = std::clamp((float(row) - 0.5F) / float(map_.height), 0.0F, 1.0F);
  return std::cos(kPi * v);
}

float EnvironmentSampling::cell_luminance(int column, int row) const {
  const int next = column + 1 < map_.width ? column + 1 : 0;
  const int above = std::max(row - 1, 0), below = std::min(row, map_.height - 1);
  return luminance(0.25F * map_.at(column, above) + 0.25F * map_.at(next, above) + 0.25F * map_.at(column, below) +
                   0.25F * map_.at(next, below));
}

void EnvironmentSampling::make_density(float taken_off) {
  constexpr float kStays = 0.1F;  // of the luminance, at least
  std::vector<double> row_weight(std::size_t(rows_), 0.0);
  parallel_for(std::size_t(rows_), [&](std::size_t row) {
    std::vector<double> weight(std::size_t(columns_), 0.0);
    const double solid_angle = double(top_cosine(int(row)) - top_cosine(int(row) + 1)) * 2 * double(kPi) / columns_;
    for (int column = 0; column < columns_; ++column) {
      const float all = cell_luminance(column, int(row)), left = std::max(kStays * all, all - taken_off);
      density_[row * std::size_t(columns_) + std::size_t(column)] = left;
      weight[std::size_t(column)] = double(left) * solid_angle;
    }
    row_weight[row] = accumulate(weight.data(), columns_, &column_end_[row * std::size_t(columns_)]);
  });
  const double total = accumulate(row_weight.data(), rows_, row_end_.data());
  if (!(total > 0)) return;  // nothing comes from anywhere
  for (float& density : density_) density = float(double(density) / total);
}

Vec3f EnvironmentSampling::radiance(Vec3f direction) const {
  return intensity_ * look_up(map_, latlong_of(rotate_about_y(direction, -rotation_)));
}

EnvironmentSampling::Sample EnvironmentSampling::sample(Vec2f u) const {
  const Step row = find_step(row_end_.data(), rows_, u.y);
  const std::size_t first = std::size_t(row.index) * std::size_t(columns_);
  const Step column = find_step(&column_end_[first], columns_, u.x);
  const float top = top_cosine(row.index), bottom = top_cosine(row.index + 1);
  const float cosine = top + row.within * (bottom - top), sine = std::sqrt(std::max(0.0F, 1 - cosine * cosine));
  const float phi = 2 * kPi * ((float(column.index) + 0.5F + column.within) / float(columns_) - 0.5F);
  Sample s;
  s.direction = normalize(rotate_about_y({sine * std::cos(phi), cosine, sine * std::sin(phi)}, rotation_));
  s.radiance = radiance(s.direction);
  s.pdf = density_[first + std::size_t(column.index)];
  return s;
}

float EnvironmentSampling::pdf(Vec3f direction) const {
  const Vec2f uv = latlong_of(rotate_about_y(direction, -rotation_));
  const int row = std::clamp(int(uv.y * float(map_.height) + 0.5F), 0, rows_ - 1);
  const int column = int(std::floor(uv.x * float(columns_) - 0.5F));
  const int wrapped = column < 0 ? columns_ - 1 : std::min(column, columns_ - 1);
  return density_[std::size_t(row) * std::size_t(columns_) + std::size_t(wrapped)];
}

}  // namespace chiaro::renderer
