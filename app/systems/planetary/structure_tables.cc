#include "app/systems/planetary/structure_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "app/scene/key_checks.h"
#include "app/scene/scene_declare.h"
#include "app/scene/scene_files.h"
#include "app/systems/planetary/carrier_pins.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/structure_input.h"
#include "app/systems/shared/space_input.h"
#include "app/systems/shared/space_tables.h"
#include "core/errors.h"
#include "core/units.h"

namespace annulus::app {

namespace {

using Body = dynamics::StageBody::Kind;

constexpr double furthest_mm = 1e5;

Table carrier_structure_table() {
  Declarations<CarrierStructureInput> structure(
      "carrier_structure",
      "What the carrier gives way, beside the pins: webs between two rigid walls, in which the pins are clamped, or a "
      "stiffness matrix. The wall with the shaft is the body of the carrier; the other one winds up against it.",
      &StructureInput::carrier);
  structure.on_request();
  structure
      .key("stiffness_file", &CarrierStructureInput::file,
           "File (CSV) with the stiffness of pins and carrier in the middles of the planets, the shaft held "
           "(docs/exchange.md), such as a reduced finite-element model has. The path is relative to the scene.")
      .absent("webs");
  structure.key("webs", &CarrierStructureInput::webs, "Number of webs, evenly spaced.")
      .from(2, 50)
      .absent("a matrix")
      .one_of({"stiffness_file"});
  const auto webs = given("webs");
  const auto length = [&](const char* key, std::optional<double> CarrierStructureInput::*member, const char* meaning) {
    structure.key(key, member, meaning).above(0, furthest_mm).needed_if(webs);
  };
  length("web_circle_diameter_mm", &CarrierStructureInput::web_circle, "Diameter of the circle of their centres.");
  length("web_length_mm", &CarrierStructureInput::web_length, "Their length, from wall to wall.");
  length("web_width_mm", &CarrierStructureInput::web_width, "Their tangential width.");
  length("web_depth_mm", &CarrierStructureInput::web_depth, "Their radial depth.");
  structure
      .key("first_web_deg", &CarrierStructureInput::first_web,
           "Place of the first web, counter-clockwise from planet 1.")
      .from(-360, 360)
      .only_if(webs, "a matrix has no webs")
      .absent("half-way to planet 2");
  structure
      .choice("shaft", &CarrierStructureInput::shaft, {{"-z", dynamics::Side::low}, {"+z", dynamics::Side::high}},
              "The side of the wall that has the shaft.")
      .only_if(webs, "in a matrix the shaft is held")
      .fallback("-z", "the torque enters there");
  return structure.done();
}

Table housing_table() {
  Declarations<HousingInput> housing("housing", "What the housing gives way behind the bearings that stand on it.",
                                     &StructureInput::housing);
  housing.on_request();
  housing
      .key("stiffness_file", &HousingInput::file,
           "File (CSV) with the stiffness of the housing in the places of [[bearing]] tables (docs/exchange.md), such "
           "as a reduced finite-element model has. Bearings that it does not contain stand on rigid ground. The path "
           "is relative to the scene.")
      .required();
  return housing.done();
}

Table statics_table() {
  Declarations<StaticsInput> statics("statics", "Positions of annulus statics.", &StructureInput::statics);
  statics.optional();
  statics
      .key("carrier_positions", &StaticsInput::places,
           "Positions of the carrier over the mesh cycles after which the forces repeat, at most one in each. These "
           "are a "
           "turn where weight and loads of the housing act, otherwise the common period of the errors.")
      .from(1, 100000)
      .absent("32, of solid gears 16; with eccentric gears or pitch deviations 768, of solid gears 96");
  statics.key("mesh_phases", &StaticsInput::phases, "Positions in the mesh cycle that begins at each of them.")
      .from(1, 1000)
      .absent("8; one where no stiffness changes in the mesh cycle");
  return statics.done();
}

class StructureChecks : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    sun();
    mounts_of_ring();
    if (auto& structure = scene_.own<StructureInput>().carrier) carrier(*structure);
    if (auto& given = scene_.own<StructureInput>().housing) housing(*given);
  }

 private:
  /// Without bearings the rule of the key asks for it.
  void sun() {
    const auto& bearings = scene_.own<SpaceInput>().bearings;
    const std::string key = "supports.sun_N_per_m";
    if (!scene_.dynamics || bearings.empty() || given(key) || !usable("stage.planets") || scene_.stage.planets == 1)
      return;
    if (std::any_of(bearings.begin(), bearings.end(),
                    [](const auto& b) { return b.body == Body::sun && b.holds_radially(); }))
      return;
    problem(key,
            "is required by [dynamics] where no [[bearing]] holds the sun radially: it has the largest effect on load "
            "sharing; give a stiffness, \"floating\" or \"rigid\"");
  }

  void mounts_of_ring() {
    const std::string key = "bearing.beside_axis_mm";
    const auto& bearings = scene_.own<SpaceInput>().bearings;
    if (!usable("stage.held") || planetary(scene_).stage.held == geometry::StageMember::ring) return;
    for (std::size_t i = 0; i < bearings.size(); ++i)
      if (bearings[i].body == Body::ring && !bearings[i].beside.empty() && usable(key, i))
        problem(key, i, "is the place of a mount of a ring that does not turn; stage.held says that it turns");
  }

  void carrier(CarrierStructureInput& structure) {
    const auto& s = planetary(scene_).supports;
    if (structure.webs && usable("carrier_structure.webs") && usable("supports.planet_pin")) {
      if (s.planet_pin != PinMounting::between_walls)
        return problem("carrier_structure.webs",
                       "needs pins that are clamped in both walls: use supports.planet_pin = \"between_walls\"");
      const auto* key = "carrier_structure.web_length_mm";
      if (s.pin_length && structure.web_length && usable(key) && *structure.web_length > 2 * *s.pin_length)
        problem(key, fmt::format("is more than twice the length of the pins between the same walls, {:g} mm",
                                 *s.pin_length / units::mm));
    }
    if (!structure.file || !usable("carrier_structure.stiffness_file")) return;
    if (s.planet_pin != PinMounting::unbending && usable("supports.planet_pin"))
      return problem("carrier_structure.stiffness_file",
                     "contains the pins: leave out supports.planet_pin and its sizes");
    if (!usable("stage.planets")) return;
    try {
      structure.stiffness = read_carrier_stiffness(file_below_scene(scene_, *structure.file), scene_.stage.planets);
    } catch (const InputError& error) {
      problem("carrier_structure.stiffness_file", error.what());
    }
  }

  void housing(HousingInput& input) {
    const std::string key = "housing.stiffness_file";
    if (!usable(key)) return;
    const auto& bearings = scene_.own<SpaceInput>().bearings;
    std::vector<std::string> known, of_ring;
    for (std::size_t i = 0; i < bearings.size(); ++i) {
      const auto& b = bearings[i];
      const bool wrong_on = given("bearing.on", i) && !usable("bearing.on", i);
      if (!usable("bearing.name", i) || !usable("bearing.body", i) || wrong_on) return;
      if (b.body == Body::planet || b.on.value_or(Body::housing) != Body::housing || !b.beside.empty()) continue;
      known.push_back(column_of(b.name));
      if (b.body == Body::ring) of_ring.push_back(known.back());
    }
    if (known.empty()) return problem(key, "needs bearings that stand on the housing: add [[bearing]]");
    // The torque of a ring that is held enters the housing in its bearing.
    const bool in_bearing =
        planetary(scene_).stage.held == geometry::StageMember::ring && !scene_.own<SpaceInput>().ring_in_mounts();
    try {
      input.seats = read_point_stiffness(file_below_scene(scene_, input.file), known,
                                         in_bearing ? of_ring : std::vector<std::string>{}, "the foundation held");
    } catch (const InputError& error) {
      problem(key, error.what());
    }
  }
};

void reverse(std::vector<double>& list, std::initializer_list<std::size_t> which) {
  if (list.size() != 3) return;
  for (const std::size_t i : which) list[i] = -list[i];
}

}  // namespace

std::vector<Table> structure_tables() {
  auto tables =
      space_tables({.bodies = {{"sun", Body::sun, &GravityInput::sun, &TiltInertiaInput::sun},
                               {"planet", Body::planet, &GravityInput::planet, &TiltInertiaInput::planet},
                               {"ring", Body::ring, &GravityInput::ring, &TiltInertiaInput::ring},
                               {"carrier", Body::carrier, &GravityInput::carrier, &TiltInertiaInput::carrier}},
                    .frames = KindInSpace::Frames::housing_and_carrier});
  tables.insert(tables.end() - 2, {carrier_structure_table(), housing_table()});
  tables.push_back(statics_table());
  return tables;
}

void check_structure(Scene& scene, std::vector<Problem>& problems) {
  check_space(scene, problems);
  StructureChecks(scene, problems).run();
}

void mirror_space(Scene& scene) {
  auto& space = scene.own<SpaceInput>();
  for (auto& b : space.bearings) {
    if (b.beside.size() == 2) b.beside[1] = -b.beside[1];
    if (b.matrix.size() != 25) continue;
    constexpr double sign[] = {1, -1, 1, -1, 1};
    for (std::size_t i = 0; i < 25; ++i) b.matrix[i] *= sign[i / 5] * sign[i % 5];
  }
  const auto mirror = [](Eigen::MatrixXd& stiffness) {
    constexpr int sign[] = {1, -1, 1, -1, 1};
    Eigen::VectorXd signs(stiffness.rows());
    for (Eigen::Index i = 0; i < signs.size(); ++i) signs[i] = sign[i % 5];
    if (signs.size() % 5 == 1) signs[signs.size() - 1] = -1;  // about z
    stiffness = signs.asDiagonal() * stiffness * signs.asDiagonal();
  };
  auto& structures = scene.own<StructureInput>();
  if (auto& structure = structures.carrier) {
    structure->mirrored = true;
    if (structure->first_web) structure->first_web = -*structure->first_web;
    mirror(structure->stiffness);
  }
  if (structures.housing) mirror(structures.housing->seats.stiffness);
  for (auto& l : space.loads) {
    reverse(l.point, {1});
    reverse(l.force, {1});
    reverse(l.moment, {0, 2});
  }
  if (space.gravity) space.gravity->direction = -space.gravity->direction;
}

}  // namespace annulus::app
