# Everything that chiaro is built on, from Debian 12's packages. What is missing is named together with its package.

set(missing_packages "")

macro(require_package name debian_package)
  find_package(${name} ${ARGN} QUIET)
  if(NOT ${name}_FOUND)
    string(APPEND missing_packages "\n  ${name}: apt-get install ${debian_package}")
  endif()
endmacro()

require_package(embree libembree-dev 3)
require_package(OpenImageIO "libopenimageio-dev openimageio-tools")
require_package(PNG libpng-dev 1.6)
require_package(OpenEXR libopenexr-dev 3.1)
require_package(TinyGLTF libtinygltf-dev)
require_package(Ceres libceres-dev)
require_package(Eigen3 libeigen3-dev 3.4)
require_package(TBB libtbb-dev)
require_package(CLI11 libcli11-dev)
require_package(nlohmann_json nlohmann-json3-dev)
require_package(fmt libfmt-dev)
require_package(nanoflann libnanoflann-dev)
require_package(draco libdraco-dev)
require_package(meshoptimizer libmeshoptimizer-dev)
if(CHIARO_TESTS)
  require_package(GTest libgtest-dev)
endif()
if(CHIARO_BENCHMARKS)
  require_package(benchmark libbenchmark-dev)
endif()

# Of which Debian has no CMake configuration.
macro(require_library name header library debian_package)
  find_path(${library}_include ${header})
  find_library(${library}_library ${library})
  if(${library}_include AND ${library}_library)
    add_library(${name}::${name} UNKNOWN IMPORTED)
    set_target_properties(${name}::${name} PROPERTIES
      IMPORTED_LOCATION ${${library}_library} INTERFACE_INCLUDE_DIRECTORIES ${${library}_include})
  else()
    string(APPEND missing_packages "\n  ${name}: apt-get install ${debian_package}")
  endif()
endmacro()

require_library(OpenColorIO OpenColorIO/OpenColorIO.h OpenColorIO libopencolorio-dev)
require_library(WebP webp/decode.h webp libwebp-dev)
require_library(AVIF avif/avif.h avif libavif-dev)

# Scripts that the report's page embeds.
macro(require_script variable file debian_package)
  find_file(${variable} javascript/${file} PATHS /usr/share)
  if(NOT ${variable})
    string(APPEND missing_packages "\n  ${file}: apt-get install ${debian_package}")
  endif()
endmacro()

require_script(three_js three/three.min.js libjs-three)
require_script(orbit_controls_js three/examples/js/controls/OrbitControls.js libjs-three)
require_script(chart_js chart.js/chart.min.js libjs-chart.js)

# Debian's OpenImageIO names an include folder of OpenCV that is there only with OpenCV's own headers.
if(TARGET OpenImageIO::OpenImageIO)
  get_target_property(openimageio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER openimageio_includes EXCLUDE REGEX "opencv")
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${openimageio_includes}")
endif()

if(missing_packages)
  message(FATAL_ERROR "chiaro needs packages that are not installed:${missing_packages}\n"
                      "(or run scenes/demo.sh or tests/run.sh, which install them)")
endif()
