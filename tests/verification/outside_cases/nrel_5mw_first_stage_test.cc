#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "app/systems/shared/sun_planet_input.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/units.h"
#include "geometry/iso6336.h"
#include "tests/verification/body_torsion.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

namespace {

using namespace annulus;
using geometry::Gear;
using geometry::GearPair;
using test::Verification;

constexpr double per_mm_um = 1e9;  // N/(mm um) in Pa

/// The gears of the scene.
struct Stage {
  Gear sun, planet, ring;
  GearPair sun_mesh, ring_mesh;

  Stage(const Gear& s, const Gear& p, const Gear& r, double a)
      : sun(s), planet(p), ring(r), sun_mesh(p, s, a), ring_mesh(p, r, a) {}

  [[nodiscard]] const GearPair& mesh(const std::string& name) const {
    return name == "sun_mesh" ? sun_mesh : ring_mesh;
  }
  [[nodiscard]] const Gear& gear(const std::string& name) const {
    if (name == "sun") return sun;
    return name == "planet" ? planet : ring;
  }
};

/// The same gear with another profile shift and the root diameter that goes with it.
Gear shifted(const Gear& gear, double shift) {
  auto p = gear.parameters();
  p.profile_shift += shift;
  if (p.root_diameter) *p.root_diameter += 2 * shift * p.module;
  return Gear(p);
}

struct FirstStage {
  test::OutsideCase published{"nrel_5mw_first_stage"};
  app::Scene scene = app::read_scene(published.scene("first_stage.toml"));
  app::GearGeometry geometry = app::make_geometry(scene);
  Stage stage{geometry.rings.front().set.sun(), geometry.rings.front().set.planet(), geometry.rings.front().set.ring(),
              scene.stage.centre_distance};

  /// F_t at the reference circle.
  [[nodiscard]] double tangential_force() const {
    return geometry.operating_point.mean_mesh_force * std::cos(scene.stage.pressure_angle);
  }

  /// Half a unit of the last digit of the power, 5000.000 kW, over the power: forces and torques are proportional.
  static constexpr double power_rounding = 1e-7;

  /// Compares to the printed digits: half a unit of the last, and what half a unit of the last printed digit of the
  /// three profile shifts makes of the quantity; `relative`: the same of another input, over the quantity.
  void compare(Verification& record, const std::string& quantity, double unit,
               const std::function<double(const Stage&)>& compute, double relative = 0) const {
    const auto& printed = published.printed(quantity);
    const double computed = compute(stage) / unit, shift = 5e-5, a = scene.stage.centre_distance;
    double rounding = relative * computed;
    for (const Stage& other : {Stage(shifted(stage.sun, shift), stage.planet, stage.ring, a),
                               Stage(stage.sun, shifted(stage.planet, shift), stage.ring, a),
                               Stage(stage.sun, stage.planet, shifted(stage.ring, shift), a)})
      rounding += std::abs(compute(other) / unit - computed);
    std::string name = quantity;
    std::replace(name.begin(), name.end(), '_', ' ');
    record.near(name, printed.unit, computed, printed.value, printed.half_unit + rounding,
                "printed digits of the result, the profile shifts and the power");
  }

  /// C_R with the thickness of rim between bore and smallest root diameter.
  [[nodiscard]] double gear_blank() const {
    const auto& web = published.printed("web_thickness_over_face_width");
    const double rim =
        published.printed("smallest_root_diameter_sun").value * units::mm - *sun_and_planets(scene).sun.bore_diameter;
    return geometry::gear_blank_factor(web.value, 1, rim / 2 / scene.stage.module);
  }
};

constexpr const char* meshes[] = {"sun_mesh", "ring_mesh"};
constexpr std::pair<const char*, const char*> roots[] = {
    {"sun", "sun_mesh"}, {"planet", "sun_mesh"}, {"planet", "ring_mesh"}, {"ring", "ring_mesh"}};

}  // namespace

BOOST_AUTO_TEST_SUITE(nrel_5mw_first_stage)

BOOST_AUTO_TEST_CASE(geometry_and_forces) {
  Verification record("Geometry and forces of the first stage of the NREL 5 MW reference gearbox",
                      "KISSsoft report, digits as printed (data/cases/nrel_5mw_first_stage)");
  const FirstStage first;
  for (const std::string gear : {"sun", "planet", "ring"})
    first.compare(record, "base_diameter_" + gear, units::mm,
                  [&](const Stage& s) { return 2 * s.gear(gear).base_radius(); });
  for (const std::string gear : {"sun", "planet"})
    first.compare(record, "root_form_diameter_" + gear, units::mm,
                  [&](const Stage& s) { return 2 * s.gear(gear).form_radius(); });
  for (const std::string mesh : meshes) {
    first.compare(record, "working_pressure_angle_" + mesh, units::deg,
                  [&](const Stage& s) { return s.mesh(mesh).working_pressure_angle(); });
    first.compare(record, "contact_ratio_" + mesh, 1, [&](const Stage& s) { return s.mesh(mesh).contact_ratio(); });
    first.compare(record, "path_of_contact_" + mesh, units::mm,
                  [&](const Stage& s) { return s.mesh(mesh).roll_length_high() - s.mesh(mesh).roll_length_low(); });
    first.compare(
        record, "tangential_force_at_working_pitch_circle_" + mesh, 1,
        [&](const Stage& s) {
          return first.geometry.operating_point.mean_mesh_force * std::cos(s.mesh(mesh).working_pressure_angle());
        },
        FirstStage::power_rounding);
  }
  first.compare(record, "span_over_3_teeth_sun", units::mm,
                [](const Stage& s) { return s.sun.base_tangent_length(3); });
  first.compare(record, "span_over_3_teeth_planet", units::mm,
                [](const Stage& s) { return s.planet.base_tangent_length(3); });
  first.compare(record, "span_over_8_spaces_ring", units::mm,
                [](const Stage& s) { return s.ring.base_tangent_length(8); });
  const auto& point = first.geometry.operating_point;
  first.compare(record, "sun_speed", units::rpm,
                [&](const Stage&) { return point.flow.speed[geometry::StageMember::sun]; });
  first.compare(
      record, "sun_torque", 1, [&](const Stage&) { return point.sun_torque; }, FirstStage::power_rounding);
  first.compare(
      record, "carrier_torque", 1,
      [&](const Stage&) { return std::abs(point.flow.torque[geometry::StageMember::carrier]); },
      FirstStage::power_rounding);
  first.compare(
      record, "normal_force", 1, [&](const Stage&) { return point.mean_mesh_force; }, FirstStage::power_rounding);
  first.compare(
      record, "tangential_force", 1, [&](const Stage&) { return first.tangential_force(); },
      FirstStage::power_rounding);
}

BOOST_AUTO_TEST_CASE(tips_are_shortened_as_printed) {
  Verification record("Tip shortening of the NREL 5 MW reference gearbox",
                      "KISSsoft report: tip diameters of sun and planet, which contain a shortening of -10.861 mm");
  auto text = read_file(test::OutsideCase("nrel_5mw_first_stage").scene("first_stage.toml"));
  for (const auto* line : {"tip_diameter_mm = 978.808", "tip_diameter_mm = 905.470"})
    text.replace(text.find(line), std::string(line).size(), "");
  const std::string key = "face_width_mm = 491";
  text.replace(text.find(key), key.size(), key + "\ntip_shortening = \"full\"");
  const auto geometry = app::make_geometry(app::parse_scene(text, "scene.toml"));
  const auto& set = geometry.rings.front().set;
  // Both profile shifts are printed with four decimals: 0.0001 of 45 mm, on both sides.
  const double rounding = 1e-4 * 45 * 2;
  record.near("tip diameter of the sun", "mm", 2e3 * set.sun().tip_radius(), 978.808, rounding,
              "printed profile shifts");
  record.near("tip diameter of the planet", "mm", 2e3 * set.planet().tip_radius(), 905.470, rounding,
              "printed profile shifts");
}

BOOST_AUTO_TEST_CASE(iso_6336_figures) {
  Verification record("ISO 6336 stiffness, root stress and flank pressure of the NREL 5 MW first stage",
                      "KISSsoft report by ISO 6336:2006 method B, digits as printed (data/cases/nrel_5mw_first_stage)");
  const FirstStage first;
  const double force = first.tangential_force();
  const auto& material = first.scene.material;
  first.compare(record, "gear_blank_factor_C_R", 1, [&](const Stage&) { return first.gear_blank(); });
  for (const std::string mesh : meshes) {
    const auto stiffness = [&](const Stage& s) {
      return geometry::iso_6336_stiffness(s.mesh(mesh), {.gear_blank = first.gear_blank()});
    };
    first.compare(record, "single_stiffness_" + mesh, per_mm_um, [&](const Stage& s) { return stiffness(s).single; });
    first.compare(record, "mesh_stiffness_" + mesh, per_mm_um, [&](const Stage& s) { return stiffness(s).mesh; });
    first.compare(record, "mesh_stiffness_beta_" + mesh, per_mm_um,
                  [&](const Stage& s) { return stiffness(s).mesh_beta; });
    first.compare(record, "contact_ratio_factor_" + mesh, 1,
                  [&](const Stage& s) { return geometry::contact_ratio_factor(s.mesh(mesh)); });
    first.compare(record, "nominal_flank_pressure_" + mesh, 1e6, [&](const Stage& s) {
      return geometry::nominal_flank_pressure(
          s.mesh(mesh), force,
          fem::MeshMaterials({material.youngs_modulus, material.poisson_ratio, material.density}).contact_modulus());
    });
  }
  // A ring's root is that of its cutter, an external gear's that of its rack.
  BOOST_CHECK_THROW((void)geometry::root_section(first.stage.ring_mesh, first.stage.ring), GeometryError);
  BOOST_CHECK_THROW((void)geometry::root_section(first.stage.sun_mesh, first.stage.sun, geometry::PinionCutter{36}),
                    GeometryError);
  const auto cutter = [&](const char* name) { return first.published.printed(name).value; };
  for (const auto& [gear, mesh] : roots) {
    const auto root = [&, gear = std::string(gear), mesh = std::string(mesh)](const Stage& s) {
      std::optional<geometry::PinionCutter> made_by;
      if (gear == "ring")
        made_by = {static_cast<int>(cutter("cutter_teeth_ring")), cutter("cutter_profile_shift_ring"),
                   cutter("cutter_tip_radius_factor_ring")};
      return geometry::root_section(s.mesh(mesh), s.gear(gear), made_by);
    };
    const auto place = "_" + std::string(gear) + "_in_" + mesh;
    first.compare(record, "chord" + place, units::mm, [&](const Stage& s) { return root(s).chord; });
    first.compare(record, "lever" + place, units::mm, [&](const Stage& s) { return root(s).lever; });
    first.compare(record, "fillet_radius" + place, units::mm, [&](const Stage& s) { return root(s).fillet_radius; });
    first.compare(record, "load_angle" + place, units::deg, [&](const Stage& s) { return root(s).load_angle; });
    first.compare(record, "form_factor" + place, 1, [&](const Stage& s) { return root(s).form_factor; });
    first.compare(record, "stress_correction" + place, 1, [&](const Stage& s) { return root(s).stress_correction; });
    first.compare(record, "nominal_root_stress" + place, 1e6, [&, gear = std::string(gear)](const Stage& s) {
      return geometry::nominal_root_stress(s.gear(gear), root(s), force);
    });
  }
}

BOOST_AUTO_TEST_CASE(finite_elements_beside_iso_6336) {
  Verification record("Finite elements beside the ISO 6336 figures of the NREL 5 MW first stage",
                      "KISSsoft report by ISO 6336:2006 method B (data/cases/nrel_5mw_first_stage: why they differ)");
  const FirstStage first;
  const auto out = first.published.run("first_stage.toml");
  std::ifstream file(out / "summary.json");
  const auto ring = nlohmann::json::parse(file).at("rings").at("outside_held");
  const double planet_base = first.stage.planet.base_radius(), width = first.scene.stage.face_width;
  const double load = first.geometry.operating_point.mean_mesh_force;

  for (const std::string mesh : meshes) {
    const bool sun = mesh == "sun_mesh";
    const auto folder = sun ? out : out / "outside_held";
    const std::string table = sun ? "sun_planet.csv" : "ring_planet.csv";
    const auto& pair = first.stage.mesh(mesh);
    const std::string at = sun ? ", sun mesh" : ", ring mesh";

    // Pieces of the flanks that touch, by mesh phase and pair. A length along the flank is rho / r_b times the roll
    // length.
    struct Patch {
      double force = 0, peak = 0, longest = 0;  // N/m, Pa, m
    };
    std::map<double, std::map<int, Patch>> positions;
    const auto pressures = Csv::read(folder / ("pressure_" + table));
    const auto cell = [](const Csv& csv, const std::vector<double>& row, const char* name) {
      return row[csv.column(name)];
    };
    for (const auto& row : pressures.rows) {
      const double low = cell(pressures, row, "roll_low_mm") * units::mm,
                   high = cell(pressures, row, "roll_high_mm") * units::mm,
                   pressure = cell(pressures, row, "pressure_MPa") * 1e6;
      const double length = (high * high - low * low) / 2 / planet_base;
      auto& patch = positions[cell(pressures, row, "mesh_phase")][static_cast<int>(cell(pressures, row, "pair"))];
      patch.force += pressure * length;
      patch.peak = std::max(patch.peak, pressure);
      patch.longest = std::max(patch.longest, length);
    }

    // At phase 0 a pair touches at the pitch point: the first of the pairs, the others follow towards the tip. The
    // nominal pressure over Z_epsilon is that of the whole force there; a pair with the share f has its root.
    const Patch& pitch = positions.at(0).begin()->second;
    const double whole =
        first.published.printed("nominal_flank_pressure_" + mesh).value * 1e6 / geometry::contact_ratio_factor(pair);
    const double share = pitch.force * width / load, expected = whole * std::sqrt(share);
    const double half_width = 2 * pitch.force / (std::numbers::pi * expected);
    record.close("pressure at the pitch point" + at + ", from the printed nominal pressure", "Pa", pitch.peak, expected,
                 std::pow(pitch.longest / half_width, 2) / 2, "discretisation (h / b)^2 / 2 of the longest piece");

    // Theoretical single stiffness: solid bodies, no C_M.
    const auto stiffness = Csv::read(folder / ("stiffness_" + table));
    double largest = 0;
    for (const auto& row : stiffness.rows) {
      const auto found = positions.find(cell(stiffness, row, "mesh_phase"));
      if (found == positions.end() || found->second.size() > 1) continue;
      if (std::abs(cell(stiffness, row, "load_N") / load - 1) < 1e-6)
        largest = std::max(largest, cell(stiffness, row, "stiffness_secant_N_per_m"));
    }
    BOOST_TEST_REQUIRE(largest > 0);
    const double torsion =
        test::body_torsion(first.stage.planet, *sun_and_planets(first.scene).planet.bore_diameter / 2, {}) +
        (sun ? test::body_torsion(first.stage.sun, *sun_and_planets(first.scene).sun.bore_diameter / 2, {})
             : test::body_torsion(first.stage.ring, first.geometry.rings.front().outside_radius, {}));
    record.close("largest stiffness with a single pair" + at + ", bodies taken off", "N/(mm um)",
                 1 / (width / largest - torsion) / per_mm_um,
                 first.published.printed("single_stiffness_" + mesh).value /
                     (first.published.printed("correction_factor_C_M").value * first.gear_blank()),
                 0.10, "accuracy ascribed to the formula (tests/verification/iso6336_stiffness/README.md)");
  }

  for (const auto& [gear, mesh] : roots) {
    const bool sun = std::string(mesh) == "sun_mesh";
    const double tension = ring.at(sun ? "sun_planet" : "ring_planet")
                               .at("max_stress_Pa")
                               .at(std::string(gear) + "_root_tension")
                               .at("value");
    record.at_most("root tension of the " + std::string(gear) + (sun ? ", sun mesh" : ", ring mesh"), "MPa",
                   tension / 1e6,
                   first.published.printed("nominal_root_stress_" + std::string(gear) + "_in_" + mesh).value,
                   "the printed bending stress leaves out the radial force, which presses on the root");
  }
}

// A misaligned mesh of solid gears beside ISO 6336-1 (method C): K_Hbeta = 1 + F_beta c_gamma_beta b / (2 F_m) while
// the whole face touches. Uniform springs of stiffness k per length have a moment F_beta k b^2 / 12 along the face.
BOOST_AUTO_TEST_CASE(misaligned_sun_mesh) {
  Verification record("Misaligned sun mesh of the NREL 5 MW first stage",
                      "ISO 6336-1, method C (data/cases/nrel_5mw_first_stage: why they differ)");
  const FirstStage first;
  constexpr double misalignment = 50 * units::um;  // over the face
  const std::string solid_sun_mesh =
      "--set model=solid --set accuracy=0.01 --set mesh.ring_planet.stiffness=constant "
      "--set mesh.ring_planet.mean_N_per_m=9e9 --set errors.sun_planet_misalignment_um=";
  const auto aligned = first.published.solve("first_stage.toml", solid_sun_mesh + "0");
  const auto out = first.published.solve("first_stage.toml", solid_sun_mesh + "50");
  const double load = first.geometry.operating_point.mean_mesh_force, width = first.scene.stage.face_width;
  const auto factor_of = [&](double stiffness) { return 1 + misalignment * stiffness * width / (2 * load); };

  std::map<double, std::map<double, double>> loads;  // N/m of all pairs, by mesh phase and place from the middle
  const auto lines = Csv::read(out / "line_load_sun_planet.csv");
  for (const auto& row : lines.rows) {
    const double low = row[lines.column("z_low_mm")] * units::mm, high = row[lines.column("z_high_mm")] * units::mm;
    loads[row[lines.column("mesh_phase")]][(low + high) / 2 - width / 2] =
        row[lines.column("line_load_N_per_mm")] / units::mm;
  }
  // The places where a pair touches, by mesh phase and pair.
  const auto contacts = [](const std::filesystem::path& folder) {
    std::map<double, std::map<double, std::set<double>>> places;
    const auto pressures = Csv::read(folder / "pressure_sun_planet.csv");
    for (const auto& row : pressures.rows)
      places[row[pressures.column("mesh_phase")]][row[pressures.column("pair")]].insert(
          row[pressures.column("z_low_mm")]);
    return places;
  };
  const auto touching = contacts(out), touching_aligned = contacts(aligned);
  std::map<double, double> tangents;
  const auto stiffness = Csv::read(aligned / "stiffness_sun_planet.csv");
  for (const auto& row : stiffness.rows)
    if (std::abs(row[stiffness.column("load_N")] / load - 1) < 1e-6)
      tangents[row[stiffness.column("mesh_phase")]] = row[stiffness.column("stiffness_tangent_N_per_m")];
  double largest = 0, mean = 0;
  for (const auto& [phase, whole] : loads) {
    double force = 0, moment = 0, top = 0;
    const double piece = width / static_cast<double>(whole.size());
    for (const auto& [z, line] : whole) {
      force += line * piece;
      moment += line * piece * z;
      top = std::max(top, line);
    }
    record.close("force of the whole face", "N", force, load, 1e-5, "digits of the file");
    const double tilting = 12 * std::abs(moment) / (misalignment * width * width), factor = top * width / load;
    const auto& pairs = touching.at(phase);
    const bool all = std::all_of(pairs.begin(), pairs.end(),
                                 [pieces = whole.size()](const auto& pair) { return pair.second.size() == pieces; });
    if (all && pairs.size() == touching_aligned.at(phase).size()) {  // else a part of the face has another pair
      record.close("K_Hbeta of straight line loads with this moment", "", factor, factor_of(tilting),
                   (1 - 1 / factor_of(tilting)) * 2 / static_cast<double>(whole.size()),
                   "a piece of the face at its end");
      record.at_least("stiffness against a tilt over that against an approach", "",
                      tilting * width / tangents.at(phase - std::floor(phase)), 1,
                      "what gives way as a whole, bodies and hubs, does not tilt");
    }
    largest = std::max(largest, factor);
    mean += factor / static_cast<double>(loads.size());
  }
  std::ifstream file(out / "summary.json");
  record.close(
      "largest K_Hbeta", "",
      nlohmann::json::parse(file).at("rings").at("outside_held").at("sun_planet").at("face_load_factor").at("value"),
      largest, 1e-4, "digits of the file");
  // The standard lowers its stiffness to measured ones (C_M), to wheels with webs (C_R) and once more for K_Hbeta.
  const double as_printed = first.published.printed("mesh_stiffness_beta_sun_mesh").value * per_mm_um;
  record.near("mean K_Hbeta of a mesh cycle, from the page of the case", "", mean, 1.33, 0.005, "digits of the page");
  record.near("largest K_Hbeta, from the page of the case", "", largest, 1.47, 0.005, "digits of the page");
  record.at_least("mean K_Hbeta of a mesh cycle over that of ISO as printed", "", mean / factor_of(as_printed), 1,
                  "C_M, C_R and the factor 0.85 of c_gamma_beta lower the stiffness");
}

BOOST_AUTO_TEST_SUITE_END()
