#pragma once
// Configs of OpenColorIO that are safe to use.

#include <filesystem>

#include <OpenColorIO/OpenColorIO.h>

namespace chiaro::renderer {

// Error, naming the file, for what is none or is damaged, and for what OpenColorIO would follow without end: spaces,
// looks and views that refer to themselves or to more than there is any use of, files of pipes and devices.
OCIO_NAMESPACE::ConstConfigRcPtr load_config(const std::filesystem::path& path);

}  // namespace chiaro::renderer
