#include "configuration/parameters.h"

#include "configuration/peer_file.h"
#include "parameters/parameters_text.h"
#include "parameters/tree_reader.h"

namespace robot_control {
namespace {

void check_timeouts(const Schema& schema, const LoopParameters& loop, GivenValues& given) {
  if (given.refused("robot.rate")) return;
  for (const Block& block : schema.blocks) {
    for (const Key& key : block.keys) {
      const std::string path = path_of(block, key);
      const auto* const* number = std::get_if<double*>(&key.field);
      if (number == nullptr || !given.accepted(path)) continue;
      if ((key.traits & kLoopTimeout) != 0 && **number != 0 && **number < 2 * loop.period()) {
        given.refuse(path, "must be 0 (off) or at least two periods, " + shortest(2 * loop.period()) + " s at " +
                               shortest(loop.rate) + " Hz");
      }
    }
  }
}

void check_stop_delay(const Parameters& parameters, GivenValues& given) {
  const std::string delay = std::string(program_of(Role::kMonitor)) + ".stop_delay";
  const double fastest = fastest_stop(parameters.loop.period());
  if (!given.accepted(delay) || !given.accepted("robot.rate") || *parameters.safety.stop_delay >= fastest) return;
  given.refuse(delay, "must be at least three periods, " + shortest(fastest) + " s at " +
                          shortest(parameters.loop.rate) + " Hz: no stop is faster");
}

}  // namespace

Programs programs_of(const Parameters& parameters, std::string_view kind) noexcept {
  const bool simulator = parameters.driver == DriverName::kMujoco;
  return {.kind = kind, .driver = simulator ? program_of(Role::kDriver) : "driver"};
}

Schema schema(Parameters& p) {
  const auto file = [](std::string_view name, std::string& path, unsigned traits) {
    return Keys{{name, &path, {}, 0, 0, kPath | traits}};
  };
  const Key no_effect{"standstill_acceleration", &p.no_effect, "m/s²", 0.001, 10, kOptional | kObsolete};
  return {
      .blocks = {{"robot", joined({file("urdf", p.urdf, 0),
                                   {{"kind", &p.kind, {}, 0, 0, kOptional}, {"simulated_laser", &p.simulated_laser}},
                                   keys(p.robot),
                                   keys(p.legs),
                                   keys(p.loop),
                                   {{"driver", &p.driver, {}, 0, 0, kOptional}},
                                   file("drives", p.drives, kMayBeEmpty | kOptional),
                                   {{"imu", &p.imu, {}, 0, 0, kOptional}}})},
                 {program_of(Role::kDriver), joined({keys(p.plant), plant_keys(p.report)})},
                 {program_of(Role::kEstimator), joined({keys(p.estimator),
                                                        {no_effect},
                                                        file("calibration_file", p.calibration_file, kMayBeEmpty),
                                                        estimator_keys(p.report)})},
                 {program_of(Role::kController),
                  joined({keys(p.controller), file("command_sources", p.command_sources, kMayBeEmpty | kOptional),
                          controller_keys(p.report)})},
                 {names_of_kind(kLeggedKind).controller, joined({keys(p.leg_control), leg_control_keys(p.report)})},
                 {program_of(Role::kMonitor),
                  joined({keys(p.safety), file("latch_file", p.latch_file, kMayBeEmpty | kOptional)})},
                 {program_of(Role::kTelemetry), keys(p.telemetry)},
                 {"slam", keys(p.slam)},
                 {"localization", keys(p.localization)},
                 {"navigate", keys(p.navigate)},
                 {"collision_guard", keys(p.collision_guard)}},
      .check =
          [&p](const Schema& all, GivenValues& given) {
            check_timeouts(all, p.loop, given);
            check(p.safety, std::string(program_of(Role::kMonitor)), given);
            check(p.controller, std::string(program_of(Role::kController)), given);
            check(p.leg_control.gaits, std::string(names_of_kind(kLeggedKind).controller), given);
            check_stop_delay(p, given);
          },
      .other_package_remedy = &suggest_for_peer_key,
  };
}

Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays,
                           const std::string& base_path) {
  const std::string source = yaml_path.empty() ? "the given values" : yaml_path;
  const std::string subject = "parameters refused (" + source + ")";
  ProblemList problems;
  ParameterTree tree = read_tree(yaml_path, overlays, problems, &peer_problem, base_path);
  if (tree.blocks.empty() && !yaml_path.empty())
    problems.throw_if_any(subject);  // without any block the file is no parameter file
  Parameters parameters;
  const Schema all = schema(parameters);
  parameters.warnings = read_blocks(std::move(tree), all, all.blocks, source, problems);
  problems.throw_if_any(subject);
  return parameters;
}

std::string parameters_text(Parameters parameters) {
  return blocks_text(schema(parameters).blocks);
}

}  // namespace robot_control
