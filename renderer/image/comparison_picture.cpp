#include "renderer/image/comparison_picture.h"

#include <algorithm>
#include <cmath>

#include "renderer/image/heat_map.h"
#include "renderer/image/small_text.h"

namespace chiaro::renderer {
namespace {

constexpr float kDifferenceGain = 8;

// Where panels and captions lie.
struct Layout {
  int width, height;  // of a panel
  int text_scale, caption;

  explicit Layout(const Image& panel)
      : width(panel.width),
        height(panel.height),
        text_scale(std::clamp(panel.width / 240, 1, 3)),
        caption((kTextHeight + 4) * text_scale) {}

  int left(int column) const { return column * width; }
  int top(int row) const { return row * (height + caption); }
  int margin() const { return 2 * text_scale; }
  int text_top(int row) const { return top(row) + height + margin(); }
};

void paste(const Image& panel, int left, int top, Image& picture) {
  for (int y = 0; y < panel.height; ++y) {
    std::copy(panel.at(0, y), panel.at(0, y) + std::ptrdiff_t(panel.width) * 3, picture.at(left, top + y));
  }
}

void add_panel(const Image& panel, const std::string& name, int column, int row, Image& picture) {
  const Layout layout(panel);
  paste(panel, layout.left(column), layout.top(row), picture);
  draw_text(name, layout.left(column) + layout.margin(), layout.text_top(row), layout.text_scale, picture);
}

// The colours from 0 to 1, on the right of the name.
void add_scale(const Layout& layout, int name_width, Image& picture) {
  const int space = layout.margin(), end_width = text_width("1", layout.text_scale);
  const int left = layout.left(1) + name_width + 2 * space, right = 2 * layout.width - end_width - 2 * space;
  if (right - left < 8) return;
  Image ramp = make_image(right - left, kTextHeight * layout.text_scale, {"FLIP"});
  for (int y = 0; y < ramp.height; ++y) {
    for (int x = 0; x < ramp.width; ++x) *ramp.at(x, y) = (float(x) + 0.5F) / float(ramp.width);
  }
  paste(heat_map(ramp), left, layout.text_top(1), picture);
  draw_text("1", right + space, layout.text_top(1), layout.text_scale, picture);
}

}  // namespace

Image magnified_difference(const Image& a, const Image& b) {
  Image difference = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const float value = kDifferenceGain * std::abs(a.pixels[i] - b.pixels[i]);
    difference.pixels[i] = std::isnan(value) ? 1 : value;
  }
  return difference;
}

Image comparison_picture(const ComparisonPanels& panels) {
  const Layout layout(panels.a);
  Image picture = make_image(2 * layout.width, 2 * (layout.height + layout.caption), {"R", "G", "B"});
  add_panel(panels.a, "A", 0, 0, picture);
  add_panel(panels.b, "B", 1, 0, picture);
  add_panel(panels.difference, "8 x |A - B|", 0, 1, picture);
  if (!panels.flip) return picture;
  add_panel(heat_map(*panels.flip), "FLIP 0", 1, 1, picture);
  add_scale(layout, text_width("FLIP 0", layout.text_scale), picture);
  return picture;
}

}  // namespace chiaro::renderer
