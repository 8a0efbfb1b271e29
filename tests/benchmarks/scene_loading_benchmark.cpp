// How long a glTF scene takes until rays can be traced, and how much memory it then holds, each beside what cannot be
// avoided: reading the file and building Embree's hierarchy; geometry, textures and that hierarchy.
//   scene_loading_benchmark SCENE.glb [ROUNDS]

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <embree3/rtcore.h>

#include "renderer/core/atomic_file.h"
#include "renderer/core/seconds_since.h"
#include "renderer/io/load_gltf.h"
#include "renderer/scene/texture_mip_maps.h"
#include "renderer/trace/ray_tracer.h"

namespace {

using namespace chiaro::renderer;

constexpr double kMebibyte = 1024.0 * 1024.0;

template <class T>
double bytes_of(const std::vector<T>& values) {
  return double(values.size() * sizeof(T));
}

double geometry_bytes(const Scene& scene) {
  double bytes = 0;
  for (const Mesh& mesh : scene.meshes) {
    bytes += bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.tangents) + bytes_of(mesh.colors) +
             bytes_of(mesh.triangles);
    for (const auto& uv : mesh.uv) bytes += bytes_of(uv);
  }
  return bytes + bytes_of(scene.instances);
}

double texture_bytes(const Scene& scene) {
  double bytes = 0;
  for (const Texture& texture : scene.textures) bytes += bytes_of(texture.rgba) + bytes_of(texture.wide_rgba);
  return bytes;
}

// A line of /proc/self/status, bytes.
double status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(key + ":", 0) == 0) return 1024.0 * std::atof(line.c_str() + key.size() + 1);
  }
  return 0;
}

void forget_peak() { std::ofstream("/proc/self/clear_refs") << 5; }

struct WorldMesh {
  std::vector<Vec3f> positions;  // one more than there are, as Embree reads 16 bytes for each
  const std::vector<Triangle>* triangles;
};

std::vector<WorldMesh> world_meshes(const Scene& scene) {
  std::vector<WorldMesh> meshes;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    meshes.push_back({{}, &mesh.triangles});
    for (const Vec3f& p : mesh.positions) {
      meshes.back().positions.push_back(transform_point(instance.world_from_object, p));
    }
    meshes.back().positions.push_back({});
  }
  return meshes;
}

std::atomic<long long> embree_bytes{0};

bool count_bytes(void*, ssize_t bytes, bool) {
  embree_bytes += bytes;
  return true;
}

struct Build {
  double seconds = 0, bytes = 0;
};

// Every instance as triangles of its own, of shared buffers. Only for scenes that draw each mesh once or nearly so.
Build embree_alone(const std::vector<WorldMesh>& meshes) {
  embree_bytes = 0;
  RTCDevice device = rtcNewDevice(nullptr);
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, nullptr);
  const auto start = std::chrono::steady_clock::now();
  RTCScene root = rtcNewScene(device);
  rtcSetSceneFlags(root, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(root, RTC_BUILD_QUALITY_HIGH);
  for (const WorldMesh& mesh : meshes) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3f), mesh.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles->data(), 0,
                               sizeof(Triangle), mesh.triangles->size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(root, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(root);
  const Build build{seconds_since(start), double(embree_bytes)};
  rtcReleaseScene(root);
  rtcReleaseDevice(device);
  return build;
}

void print_ratio(const char* what, double ours, double least, const char* unit) {
  std::printf("%-14s %9.3f %-3s  at least %9.3f %-3s  ratio %.2f\n", what, ours, unit, least, unit, ours / least);
}

int run(const std::string& path, int rounds) {
  double load = 1e30, trace = 1e30, file = 1e30;
  Build embree{1e30, 0};
  double held = 0, peak = 0, geometry = 0, textures = 0;
  for (int round = 0; round < rounds; ++round) {
    forget_peak();
    const double before = status_bytes("VmRSS");
    const auto start = std::chrono::steady_clock::now();
    LoadedScene loaded = load_gltf(path);
    const double loaded_seconds = seconds_since(start);
    make_mip_maps(loaded.scene);
    const auto tracer = std::make_unique<const RayTracer>(loaded.scene);
    load = std::min(load, loaded_seconds);
    trace = std::min(trace, seconds_since(start));
    if (round == 0) {
      held = status_bytes("VmRSS") - before;
      peak = status_bytes("VmHWM") - before;
      geometry = geometry_bytes(loaded.scene);
      textures = texture_bytes(loaded.scene);
    }
    const auto file_start = std::chrono::steady_clock::now();
    const std::string bytes = read_file(path);
    file = std::min(file, seconds_since(file_start));
    const Build build = embree_alone(world_meshes(loaded.scene));
    if (build.seconds < embree.seconds) embree = build;
  }
  std::printf("%s, best of %d\nload %.3f s, file %.3f s, Embree alone %.3f s\n", path.c_str(), rounds, load, file,
              embree.seconds);
  print_ratio("ready to trace", trace, file + embree.seconds, "s");
  const double least = (geometry + textures + embree.bytes) / kMebibyte;
  std::printf("geometry %.1f MiB, textures %.1f MiB, Embree %.1f MiB\n", geometry / kMebibyte, textures / kMebibyte,
              embree.bytes / kMebibyte);
  print_ratio("memory held", held / kMebibyte, least, "MiB");
  print_ratio("memory, peak", peak / kMebibyte, least, "MiB");
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s SCENE.glb [ROUNDS]\n", arguments[0]);
    return 2;
  }
  return run(arguments[1], count > 2 ? std::max(1, std::atoi(arguments[2])) : 3);
}
