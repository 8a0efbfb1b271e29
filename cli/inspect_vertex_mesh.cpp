#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "cli/inspect.h"
#include "inverse/transport/receivers.h"

namespace chiaro::cli {
namespace {

using renderer::Vec3f;
using renderer::VertexMesh;
using renderer::VertexMeshPart;

// Over all vertices that carry a value.
struct IlluminationFigures {
  std::size_t count = 0, black = 0;
  double sums[3] = {};
  Vec3f max;
  double squares = 0, error_squares = 0;

  Vec3f mean() const {
    const double n = double(std::max<std::size_t>(1, count));
    return {float(sums[0] / n), float(sums[1] / n), float(sums[2] / n)};
  }
  void add(Vec3f value) {
    ++count;
    if (renderer::max_component(value) <= 0) ++black;
    for (int c = 0; c < 3; ++c) sums[c] += double(value[c]);
    max = renderer::max(max, value);
    squares += renderer::squared_norm(value);
  }
};

struct WeightFigures {
  double min = std::numeric_limits<double>::infinity(), max = 0;
  std::size_t zero = 0;
};

bool has_values(const VertexMeshPart& part) { return !part.illumination.empty() || !part.color.empty(); }

// As a solve takes them, with a --target-scale of 1.
IlluminationFigures illumination_figures(const VertexMesh& mesh) {
  IlluminationFigures figures;
  for (const VertexMeshPart& part : mesh.parts) {
    for (const Vec3f value : part.illumination.empty() ? part.color : part.illumination) figures.add(value);
    // The error stored is the root mean square over three channels.
    for (const float error : part.standard_error) figures.error_squares += 3 * double(error) * double(error);
  }
  return figures;
}

// A part without values weighs nothing, one without weights 1.
WeightFigures weight_figures(const VertexMesh& mesh) {
  WeightFigures figures;
  for (const VertexMeshPart& part : mesh.parts) {
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
      const float weight = !has_values(part) ? 0 : part.weight.empty() ? 1 : part.weight[i];
      figures.min = std::min(figures.min, double(weight));
      figures.max = std::max(figures.max, double(weight));
      figures.zero += weight == 0;
    }
  }
  return figures;
}

bool has_illumination(const VertexMesh& mesh) {
  return std::any_of(mesh.parts.begin(), mesh.parts.end(),
                     [](const VertexMeshPart& part) { return !part.illumination.empty(); });
}

void add_receivers(Inspection& inspection, const VertexMesh& mesh) {
  const inverse::Receivers receivers = inverse::receivers_from_mesh(mesh);
  inspection.add("receivers", receivers.size(), "receivers", fmt::format("{}", receivers.size()));
  inspection.add("triangles", receivers.triangles.size(), "triangles", fmt::format("{}", receivers.triangles.size()));
  inspection.add("parts", receivers.parts.size(), "parts", fmt::format("{}", receivers.parts.size()));
  renderer::Box3f box;
  for (const Vec3f position : receivers.positions) box.extend(position);
  if (!box.empty()) {
    inspection.add("bounds", JsonObject{{"min", box.min}, {"max", box.max}}, "bounds",
                   fmt::format("{} to {} m", text_of_vector(box.min), text_of_vector(box.max)));
  }
  const std::string fingerprint = inverse::fingerprint(receivers);
  inspection.add("fingerprint", fingerprint, "fingerprint", fingerprint);
}

void add_attribute(Inspection& inspection, const VertexMesh& mesh) {
  if (has_illumination(mesh)) {
    inspection.add("attribute", "_ILLUMINATION", "values", "_ILLUMINATION");
  } else {
    inspection.add("attribute", "COLOR_0", "values", "COLOR_0, as with --target-scale 1");
  }
}

void add_illumination(Inspection& inspection, const IlluminationFigures& figures) {
  inspection.add("mean_illumination", figures.mean(), "mean illumination", text_of_vector(figures.mean()) + " cd/m²");
  inspection.add("max_illumination", figures.max, "largest illumination", text_of_vector(figures.max) + " cd/m²");
  inspection.add("black", figures.black, "black", fmt::format("{} receivers", figures.black));
  if (figures.error_squares <= 0 || figures.squares <= 0) return;
  const double error = std::sqrt(figures.error_squares / figures.squares);
  inspection.add("relative_standard_error", error, "relative standard error", text_of_percent(error));
}

void add_weights(Inspection& inspection, const WeightFigures& figures) {
  inspection.add("weight", JsonObject{{"min", figures.min}, {"max", figures.max}, {"zero", figures.zero}}, "weights",
                 fmt::format("{:.4g} to {:.4g}, of {} receivers 0", figures.min, figures.max, figures.zero));
}

}  // namespace

Inspection inspect_vertex_mesh(const std::string& file) {
  const VertexMesh mesh = renderer::load_vertex_mesh(file);
  const IlluminationFigures figures = illumination_figures(mesh);
  Inspection inspection = start_inspection(figures.count > 0 ? "target" : "receivers", file);
  inspection.warnings = mesh.warnings;
  add_receivers(inspection, mesh);
  if (figures.count == 0) return inspection;
  add_attribute(inspection, mesh);
  add_illumination(inspection, figures);
  add_weights(inspection, weight_figures(mesh));
  if (figures.black == figures.count) inspection.warnings.push_back(file + ": the illumination is black everywhere");
  return inspection;
}

}  // namespace chiaro::cli
