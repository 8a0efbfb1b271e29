#include <memory>
#include <optional>

#include <fmt/format.h>

#include "cli/add_options.h"
#include "cli/commands.h"
#include "cli/illumination_base.h"
#include "cli/illumination_view.h"
#include "cli/program.h"
#include "cli/scene_loading.h"
#include "cli/target_options.h"
#include "cli/text_output.h"
#include "cli/transport_options.h"
#include "inverse/target/illumination_picture.h"
#include "inverse/target/paint.h"

namespace chiaro::cli {
namespace {

struct PaintCommand {
  CommonOptions common;
  TransportOptions transport;
  SurfaceOptions surface;
  IlluminationPictureOptions picture;
  std::string scene, strokes, from, output;
  std::optional<float> unpainted_weight;
  float target_scale = 1;  // of --from
  const CLI::App* command = nullptr;
};

constexpr float kUnpaintedWeightOnCurrent = 1;
constexpr float kUnpaintedWeightOnBlack = 0.05F;

// What the strokes are applied to.
inverse::Target make_base(const PaintCommand& options, const LoadedStage& stage, const inverse::Strokes& strokes,
                          Session& session) {
  // Whatever the base: options of an environment that is none are refused.
  const renderer::Lights lights =
      choose_lights(stage, "", in_config(options.transport.environment, options.picture.view.config), session);
  if (!options.from.empty()) {
    return load_illumination_on(stage, options.from, options.target_scale, session);
  }
  if (strokes.base == inverse::StrokeBase::kBlack)
    return black_target(choose_receivers(*stage.tracer, options.surface, session));
  require_light(stage, lights, "lights in the scene, or strokes whose base is black");
  return trace_target(*stage.tracer, choose_receivers(*stage.tracer, options.surface, session), lights,
                      trace_options(options.transport, options.common), session.control())
      .target;
}

// Absent: the base's weights.
std::optional<float> unpainted_weight(const PaintCommand& options, const inverse::Strokes& strokes) {
  if (options.unpainted_weight || !options.from.empty()) return options.unpainted_weight;
  return strokes.base == inverse::StrokeBase::kBlack ? kUnpaintedWeightOnBlack : kUnpaintedWeightOnCurrent;
}

void warn_of_misses(const PaintCommand& options, const inverse::PaintResult& result, Session& session) {
  const auto warn = [&](std::size_t stroke, const std::vector<std::size_t>& points, const char* what) {
    for (const std::size_t point : points) {
      session.warn(fmt::format("{}: strokes[{}].path[{}]: {} farther from any surface than the stroke's radius",
                               options.strokes, stroke, point, what));
    }
  };
  for (std::size_t i = 0; i < result.far_points.size(); ++i) {
    warn(i, result.far_points[i], "is");
    warn(i, result.far_images[i], "its mirror image is");
  }
  for (std::size_t i = 0; i < result.touched.size(); ++i) {
    if (result.touched[i] > 0) continue;
    session.warn(fmt::format("{}: strokes[{}]: touches no receiver", options.strokes, i));
  }
  if (is_black(result.target)) session.warn(options.output + ": the illumination is black everywhere");
}

void print_summary(Session& session, const PaintCommand& options, const inverse::PaintResult& result) {
  JsonList touched;
  std::vector<TextRow> rows;
  for (std::size_t i = 0; i < result.touched.size(); ++i) {
    touched.emplace_back(result.touched[i]);
    rows.emplace_back(fmt::format("stroke {}", i), fmt::format("{} receivers", result.touched[i]));
  }
  rows.emplace_back("receivers", fmt::format("{}", result.target.receivers.size()));
  rows.emplace_back("mean illumination", text_of_vector(mean_illumination(result.target)) + " cd/m²");
  JsonObject summary{{"output", options.output},
                     {"receivers", result.target.receivers.size()},
                     {"touched", touched},
                     {"mean_illumination", mean_illumination(result.target)},
                     {"seconds", session.seconds()}};
  if (options.picture.file.empty()) {
    rows.emplace_back("written", options.output);
  } else {
    rows.emplace_back("written", fmt::format("{}, {}", options.output, options.picture.file));
    summary.emplace_back("picture", options.picture.file);
  }
  session.finish(summary, aligned_rows(rows));
}

// Of the light that a base is traced under. A picture shows what alpha the materials leave.
void warn_of_idle_light(const PaintCommand& options, const char* why, Session& session) {
  session.warn(given_for_nothing(
      *options.command,
      {"--samples", "--bounces", "--environment", "--environment-rotation", "--environment-intensity"}, why));
  if (options.picture.file.empty()) {
    session.warn(given_for_nothing(*options.command, {"--materials", "--albedo"}, why));
  }
}

void warn_of_idle_options(const PaintCommand& options, const inverse::Strokes& strokes, Session& session) {
  session.warn(idle_options(*options.command, {"--camera", "--width", "--height", "--hide-backs"}, {"--picture"}));
  session.warn(idle_view_options(*options.command, {"--picture"}, {"--environment"}));
  session.warn(idle_options(*options.command, {"--target-scale"}, {"--from"}));
  if (!options.from.empty()) {
    session.warn(
        given_for_nothing(*options.command, {"--on", "--max-edge"}, "with --from, which has receivers of its own"));
    warn_of_idle_light(options, "with --from, which has an illumination of its own", session);
  } else if (strokes.base == inverse::StrokeBase::kBlack) {
    warn_of_idle_light(options, "on strokes whose base is black", session);
  }
}

int run_paint(const PaintCommand& options) {
  Session session(options.common);
  require_picture(options.picture);
  session.require_outputs({options.output, options.picture.file});
  const inverse::Strokes strokes = inverse::load_strokes(options.strokes);
  const LoadedStage stage = load_stage(options.scene, options.transport.load, options.transport.materials, session);
  const std::optional<PictureCamera> camera = choose_picture_camera(options.picture, *stage.scene, session);
  const inverse::Target base = make_base(options, stage, strokes, session);
  const inverse::PaintResult result =
      inverse::paint(base, strokes, {.unpainted_weight = unpainted_weight(options, strokes)}, session.control());
  session.stop_if_interrupted();
  warn_of_idle_options(options, strokes, session);
  warn_of_misses(options, result, session);
  std::optional<renderer::Image> picture;
  if (camera) {
    picture = inverse::illumination_picture(*stage.tracer, result.target,
                                            {camera->camera, camera->width, camera->height}, session.control());
  }
  inverse::save_target(result.target, options.output);
  if (picture) save_illumination_picture(options.picture, *picture);
  print_summary(session, options, result);
  return kDone;
}

}  // namespace

CommandRun add_paint(CLI::App& command) {
  const auto options = std::make_shared<PaintCommand>();
  options->command = &command;
  add_input(command, {"scene", "SCENE", "Scene (.glb, .gltf)"}, options->scene);
  add_input(command, {"--strokes", "S.json", "The brush strokes"}, options->strokes);
  add_input_file(command, {"--from", "T.glb", "Start from this target instead of the base the strokes name"},
                 options->from);
  add_target_scale_option(command, options->target_scale);
  add_output(command, {"-o,--output", "T2.glb", "The painted target"}, options->output, {".glb", ".gltf"});
  add_number(
      command,
      {"--unpainted-weight", "W",
       "Weight of receivers that no stroke touches (default: 1 on current, 0.05 on black, as it was with --from)"},
      options->unpainted_weight, kNotNegative);
  add_illumination_picture_options(command, options->picture);
  add_hide_backs(command, options->transport.materials);
  add_surface_options(command, options->surface);
  add_transport_options(command, options->transport, "Paths per receiver where the base is current");
  add_common_options(command, options->common);
  set_examples(command,
               "  chiaro paint room.glb --strokes strokes.json -o painted.glb\n"
               "  chiaro paint room.glb --strokes strokes.json -o painted.glb --picture painted.png --exposure 1\n"
               "  chiaro paint room.glb --strokes more.json --from painted.glb -o painted2.glb");
  return [options] { return run_paint(*options); };
}

}  // namespace chiaro::cli
