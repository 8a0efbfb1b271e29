#include "cli/run_pictures.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "cli/illumination_view.h"
#include "inverse/target/illumination_picture.h"
#include "renderer/core/atomic_file.h"
#include "renderer/image/image_file.h"

namespace chiaro::cli {
namespace {

using renderer::Image;

constexpr int kMostWidth = 960;  // pixels

// Every pixel the mean of as many as it takes.
Image shrunk(const Image& image) {
  const int step = (image.width + kMostWidth - 1) / kMostWidth;
  const std::array<int, 3> channels{image.find_channel("R"), image.find_channel("G"), image.find_channel("B")};
  Image result =
      renderer::make_image(std::max(1, image.width / step), std::max(1, image.height / step), {"R", "G", "B"});
  const int rows = std::min(step, image.height);  // of a picture that is less high than a step as well
  for (int y = 0; y < result.height * rows; ++y) {
    for (int x = 0; x < result.width * step; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        result.at(x / step, y / rows)[c] += image.at(x, y)[channels[c]] / float(step * rows);
      }
    }
  }
  return result;
}

std::string name_of(const std::string& file_name, const std::string& kind) {
  return fmt::format("{}.{}.png", file_name, kind);
}

class PictureWriter {
 public:
  PictureWriter(const RunPictures& run, const std::string& file_name) : folder_(run.folder), file_name_(file_name) {}

  PagePicture write(const std::string& kind, const std::string& title, const std::string& text,
                    const Image& shown) const {
    const std::filesystem::path file = folder_ / name_of(file_name_, kind);
    renderer::save_image(shown, file, renderer::PixelType::kUint8);
    return {title, text, renderer::read_file(file)};
  }

 private:
  std::filesystem::path folder_;
  std::string file_name_;
};

// One exposure for all illumination of a camera.
ViewChoice illumination_view(const RunPictures& run, const Image& target) {
  ViewChoice view = run.options.view;
  if (view.auto_exposure) view.view.exposure = auto_exposure(colors_of(target));
  view.auto_exposure = false;
  view.view.exposure += camera_exposure(run.options.lens);
  return view;
}

}  // namespace

std::vector<std::string> run_picture_files(const std::string& file_name) {
  return {name_of(file_name, "target"), name_of(file_name, "found"), name_of(file_name, "difference"),
          name_of(file_name, "frame")};
}

PageCamera make_page_camera(const RunPictures& run, const renderer::Camera& camera, const std::string& file_name,
                            const Image& frame, const renderer::Control& control) {
  const Image small = shrunk(frame);
  const inverse::PictureFrame size{camera, small.width, small.height};
  const Image wanted = inverse::illumination_picture(run.tracer, run.target, size, control);
  const Image found = inverse::illumination_picture(run.tracer, run.found, size, control);
  const ViewChoice view = illumination_view(run, wanted);
  ViewChoice frame_view = run.options.view;
  frame_view.view.exposure += camera_exposure(run.options.lens);
  const PictureWriter writer(run, file_name);
  const auto illumination = [&](const Image& picture) { return displayed_illumination(picture, view); };
  return {camera.name,
          {writer.write("target", "Wanted",
                        "illumination, as white surfaces would show it; hatched where none is asked for",
                        illumination(wanted)),
           writer.write("found", "Found", "illumination of the lights found", illumination(found)),
           writer.write("difference", "Difference × 8", "between the two",
                        illumination(illumination_difference(wanted, found))),
           writer.write("frame", "Frame", "the scene under the lights found", displayed(small, frame_view))}};
}

}  // namespace chiaro::cli
