#pragma once
// The surface points on which illumination lives.

#include <span>
#include <string>
#include <vector>

#include "renderer/core/control.h"
#include "renderer/io/vertex_mesh_file.h"
#include "renderer/scene/scene.h"
#include "renderer/trace/trace_illumination.h"

namespace chiaro::inverse {

using renderer::Vec3f;

// Vertices of the scene's surface after long edges are split, instances flattened, in world space.
struct Receivers {
  struct Part {  // one per instance
    std::string name;
    std::size_t first_receiver = 0, receiver_count = 0;
    std::size_t first_triangle = 0, triangle_count = 0;
  };
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;                 // unit
  std::vector<renderer::Triangle> triangles;  // over positions
  std::vector<Part> parts;
  std::vector<renderer::SurfaceSample> samples;  // where illumination is sampled: receiver_samples.h
  bool samples_moved = false;                    // from beside their vertices, to where pictures show them

  std::size_t size() const { return positions.size(); }
};

struct ReceiverOptions {
  float max_edge = 0;  // metres; 0: from the scene's size, for 20 000 to 50 000 receivers
};

// Never fewer than the scene's own vertices that triangles use. Error for a scene without triangles, and before
// memory is taken for one whose instances have more vertices than receivers may be.
Receivers make_receivers(const renderer::Scene& scene, const ReceiverOptions& options,
                         const renderer::Control& control = {});

// The vertices of a mesh file, whoever wrote it.
Receivers receivers_from_mesh(const renderer::VertexMesh& mesh);
renderer::VertexMesh mesh_from_receivers(const Receivers& receivers);

// Some of them, in the order of `chosen`: without triangles and parts.
Receivers select_receivers(const Receivers& all, std::span<const std::size_t> chosen);
// Numbers from 0 to count − 1, `most` of them where there are more, spread evenly.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most);

std::string fingerprint(const Receivers& receivers);

// Fraction of receivers (of at most 2000 looked at) that lie on the scene's surface. A target of another scene has few.
double fraction_on_surface(const renderer::RayTracer& tracer, const Receivers& receivers);

}  // namespace chiaro::inverse
