#include "cli/compared_frames.h"

#include <cmath>

#include <fmt/format.h>

#include "renderer/core/error.h"
#include "renderer/image/image_file.h"
#include "renderer/image/resize.h"
#include "renderer/image/scene_linear.h"

namespace chiaro::cli {
namespace {

using renderer::Image;
using renderer::ImageFile;

struct LoadedFrame {
  std::string name;
  ImageFile file;
  Image colors;

  bool scene_linear() const { return !file.whole_numbers; }
  bool grey() const { return renderer::is_grey(file.image); }
  bool has_alpha() const { return file.image.find_channel("A") >= 0; }
};

std::string text_of_size(const Image& image) { return fmt::format("{} x {}", image.width, image.height); }

Image rec709_of(const LoadedFrame& frame, const ViewChoice& view) {
  Image image = renderer::make_image(frame.file.image.width, frame.file.image.height, {"R", "G", "B"});
  const std::vector<renderer::Vec3f> colors = renderer::scene_linear_rec709(frame.file, frame.name, view.config);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = colors[i / 3][int(i % 3)];
  return image;
}

// Scene-linear files become Rec.709.
void convert_primaries(LoadedFrame& frame, const ViewChoice& view, std::vector<std::string>& notes) {
  if (!frame.scene_linear()) return;
  const std::string space = renderer::named_space(frame.file);
  if (space.empty() && !renderer::has_other_primaries(frame.file, frame.name)) return;
  frame.colors = rec709_of(frame, view);
  notes.push_back(
      fmt::format("{}: converted from {} to Rec.709", frame.name, space.empty() ? "its chromaticities" : space));
}

LoadedFrame load_frame(const std::string& name, const ViewChoice& view, std::vector<std::string>& notes) {
  LoadedFrame frame{name, renderer::load_image(name), {}};
  frame.colors = renderer::stored_colors(frame.file.image, name);
  convert_primaries(frame, view, notes);
  return frame;
}

void note_channels(const LoadedFrame& one, const LoadedFrame& other, std::vector<std::string>& notes) {
  if (one.grey() && !other.grey()) {
    notes.push_back(fmt::format("{}: has one channel, {} has colours: it counts as R, G and B", one.name, other.name));
  }
  if (!one.has_alpha() && other.has_alpha()) {
    notes.push_back(fmt::format("{}: has no alpha, {} has one: it is not compared", one.name, other.name));
  }
}

// What is not finite in `from` is not in `to` either, though a view shows it as something.
void keep_not_finite(const Image& from, Image& to) {
  for (std::size_t i = 0; i < from.pixels.size(); ++i) {
    if (!std::isfinite(from.pixels[i])) to.pixels[i] = from.pixels[i];
  }
}

// The scene-linear one of two becomes what the view shows.
void show_linear(LoadedFrame& one, const LoadedFrame& other, const ViewChoice& view, ComparedFrames& frames) {
  if (!one.scene_linear() || other.scene_linear()) return;
  const ViewChoice exposed = exposed_for(one.colors, view);
  Image shown = displayed(one.colors, exposed);
  keep_not_finite(one.colors, shown);
  one.colors = std::move(shown);
  frames.exposure = exposed.view.exposure;
  frames.notes.push_back(fmt::format(
      "{}: is scene-linear, {} is not: the view shows it, and display pictures are compared", one.name, other.name));
}

void match_sizes(LoadedFrame& a, const LoadedFrame& b, bool resize, std::vector<std::string>& notes) {
  if (a.colors.width == b.colors.width && a.colors.height == b.colors.height) return;
  const std::string from = text_of_size(a.colors), to = text_of_size(b.colors);
  if (!resize) {
    throw renderer::Error(
        {a.name, "", fmt::format("is {} pixels, {} is {}", from, b.name, to), "the same size, or --resize"});
  }
  a.colors = renderer::resize(a.colors, b.colors.width, b.colors.height);
  notes.push_back(fmt::format("{}: resized from {} to {} pixels", a.name, from, to));
}

}  // namespace

ComparedFrames load_compared_frames(const std::string& a, const std::string& b, const ViewChoice& view, bool resize) {
  ComparedFrames frames;
  LoadedFrame frame_a = load_frame(a, view, frames.notes), frame_b = load_frame(b, view, frames.notes);
  match_sizes(frame_a, frame_b, resize, frames.notes);
  note_channels(frame_a, frame_b, frames.notes);
  note_channels(frame_b, frame_a, frames.notes);
  show_linear(frame_a, frame_b, view, frames);
  show_linear(frame_b, frame_a, view, frames);
  frames.scene_linear = frame_a.scene_linear() && frame_b.scene_linear();
  frames.by_view = frame_a.scene_linear() || frame_b.scene_linear();
  frames.a = std::move(frame_a.colors);
  frames.b = std::move(frame_b.colors);
  return frames;
}

}  // namespace chiaro::cli
