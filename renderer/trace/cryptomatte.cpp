#include "renderer/trace/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <map>

#include <fmt/format.h>

namespace chiaro::renderer {
namespace {

std::uint32_t scrambled(std::uint32_t block) { return std::rotl(block * 0xcc9e2d51U, 15) * 0x1b873593U; }

std::uint32_t finalized(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x85ebca6bU;
  h = (h ^ (h >> 13)) * 0xc2b2ae35U;
  return h ^ (h >> 16);
}

std::string material_name(const Scene& scene, std::size_t material) {
  const std::string& name = scene.materials[material].name;
  return name.empty() ? fmt::format("material_{}", material) : name;
}

Matte matte(const char* layer, const std::map<std::string, std::uint32_t>& names) {
  return {layer, {names.begin(), names.end()}};
}

}  // namespace

std::uint32_t murmur_hash_3_32(std::string_view text) {
  const auto byte = [&](std::size_t i) { return std::uint32_t(static_cast<unsigned char>(text[i])); };
  std::uint32_t h = 0;
  std::size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    h ^= scrambled(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    h = std::rotl(h, 13) * 5 + 0xe6546b64U;
  }
  std::uint32_t tail = 0;
  for (std::size_t k = text.size(); k > i; --k) tail = tail << 8 | byte(k - 1);
  return finalized(h ^ scrambled(tail) ^ std::uint32_t(text.size()));
}

std::uint32_t matte_id(std::string_view name) {
  const std::uint32_t hash = murmur_hash_3_32(name), exponent = (hash >> 23) & 255U;
  return exponent == 0 || exponent == 255 ? hash ^ (1U << 23) : hash;
}

MatteIds matte_ids(const Scene& scene) {
  MatteIds ids;
  for (const Instance& instance : scene.instances) ids.objects.push_back(matte_id(instance.name));
  for (std::size_t m = 0; m < scene.materials.size(); ++m) ids.materials.push_back(matte_id(material_name(scene, m)));
  return ids;
}

std::vector<Matte> mattes_of(const Scene& scene) {
  std::map<std::string, std::uint32_t> objects, materials;
  for (const Instance& instance : scene.instances) {
    objects.emplace(instance.name, matte_id(instance.name));
    const std::string name = material_name(scene, std::size_t(scene.meshes[instance.mesh].material));
    materials.emplace(name, matte_id(name));
  }
  return {matte(kMatteLayers[0], objects), matte(kMatteLayers[1], materials)};
}

std::vector<std::string> matte_channels(std::string_view layer) {
  std::vector<std::string> names;
  for (int i = 0; i < kMatteLevels / 2; ++i) {
    for (const char channel : {'R', 'G', 'B', 'A'}) names.push_back(fmt::format("{}{:02}.{}", layer, i, channel));
  }
  return names;
}

void add_matte(MatteSums& sums, std::uint32_t id, int half, float samples) {
  auto found = std::find_if(sums.begin(), sums.end(), [&](const MatteCount& count) { return count.id == id; });
  if (found == sums.end()) found = sums.insert(sums.end(), {id, {0, 0}});
  found->samples[half] += samples;
}

void write_mattes(const MatteSums& sums, std::array<double, 2> half_weights, float* channels) {
  std::vector<std::pair<double, std::uint32_t>> ranked;
  for (const MatteCount& count : sums) {
    const double coverage = half_weights[0] * double(count.samples[0]) + half_weights[1] * double(count.samples[1]);
    ranked.emplace_back(-coverage, count.id);
  }
  std::sort(ranked.begin(), ranked.end());
  for (std::size_t i = 0; i < kMatteLevels; ++i) {
    const bool there = i < ranked.size();
    channels[2 * i] = there ? std::bit_cast<float>(ranked[i].second) : 0.0F;
    channels[2 * i + 1] = there ? float(-ranked[i].first) : 0.0F;
  }
}

}  // namespace chiaro::renderer
