#pragma once
// Colour management, through OpenColorIO.

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/image/image.h"

namespace chiaro::renderer {

struct ViewOptions {
  std::string display;    // empty: the config's default
  std::string view;       // empty: the display's default
  float exposure = 0;     // EV, a gain of 2^exposure in scene-linear before the view
  std::string look = {};  // in place of the view's own looks; empty: those, "none": none
};

// The config that is used: `explicit_config` if given, else $OCIO if set, else color/config.ocio of our own data folder
// ($CHIARO_DATA, or found relative to the executable). Error where there is none.
std::filesystem::path find_ocio_config(const std::optional<std::filesystem::path>& explicit_config);

// The first three channels of `image` (scene-linear Rec.709) as the display and view show them, "R","G","B", 0 to 1.
// Error, naming the choices, where the config has no such display, view or look.
Image apply_display_view(const Image& image, const std::filesystem::path& config, const ViewOptions& options);

// The inverse: the first three channels, 0 to 1 as the view shows them, to scene-linear Rec.709 with the exposure
// undone; further channels stay. What the view clips comes back as its brightest. Error as above, and where the view
// has no inverse.
Image to_rec709_from_display_view(const Image& image, const std::filesystem::path& config, const ViewOptions& options);

// From scene-linear Rec.709 to a named space (or role) of the config, in place, on the first three channels and on
// every layer's `.R,.G,.B`-triple named in `color_layers` (prefixes, "" = the beauty).
void convert_from_rec709(Image& image, const std::filesystem::path& config, const std::string& space,
                         const std::vector<std::string>& color_layers);

// Error, naming the spaces that do, where colours of this space (or role) do not add up as light does: where its values
// are no linear function of scene-linear Rec.709.
void require_linear_space(const std::filesystem::path& config, const std::string& space);

// The space's own name, where `space` may be a role or an alias of it.
std::string name_of_space(const std::filesystem::path& config, const std::string& space);

// The first three channels from a named space (or role) of the config to scene-linear Rec.709, in place. Error, naming
// the choices, where the config has no such space.
void convert_to_rec709(Image& image, const std::filesystem::path& config, const std::string& space);

// CIE xy chromaticities (red x, y, green, blue, white) of a scene-linear space of the config; absent where they cannot
// be told.
std::optional<std::array<float, 8>> chromaticities_of(const std::filesystem::path& config, const std::string& space);

}  // namespace chiaro::renderer
