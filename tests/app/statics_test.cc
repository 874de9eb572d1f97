#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "core/beam.h"
#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "core/units.h"
#include "dynamics/spatial/carrier_structure.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/app/statics_scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// annulus statics, from a scene to its files.
BOOST_AUTO_TEST_SUITE(statics)

using namespace annulus;

using namespace annulus::test::statics;

constexpr double pi = std::numbers::pi;

// The lumped model answers the same equilibrium at every position of its window, which is the error period: planets and
// sun are eccentric, and neither is in step with a turn of the carrier. Its largest load sharing is that of 64
// positions in each mesh cycle.
BOOST_AUTO_TEST_CASE(plane_stage_shares_the_load_as_the_lumped_model_does) {
  test::Verification record("annulus statics, plane stage", "quasi-static load sharing of annulus run");
  const test::TemporaryFolder folder("statics_1");
  auto scene = test::replaced(test::quick_scene(), "sun_N_per_m = 1e7", "sun_N_per_m = 1e9");
  scene = test::replaced(scene, "[errors]\n", "[errors]\nsun_eccentricity_um = 40\n");
  const auto statics = solved(folder, scene);
  BOOST_TEST(statics.at("rings").at("held").at("degrees_of_freedom") == "plane");
  const auto run = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  // A run leaves the files of the statics alone, and the other way round.
  BOOST_TEST(std::filesystem::exists(folder.path() / "out/statics.html"));
  const auto summary = Json::parse(read_file(folder.path() / "out/summary.json"));
  for (const std::string mesh : {"sun_planet", "ring_planet"}) {
    const auto& other = summary.at("rings").at("held").at("load_sharing").at(mesh).at("quasi_static");
    const auto& entry = statics.at("rings").at("held").at("results").at(mesh + "_static_load_sharing_instantaneous");
    const double error = entry.at("error").get<double>();
    BOOST_TEST(error < 0.02);
    record.near("largest load sharing in any position", "", entry.at("value").get<double>(),
                other.at("value").get<double>(), error + 1e-4, "stated error");
    BOOST_TEST(!statics.at("rings").at("held").at("results").contains(mesh + "_static_face_load_factor"));
  }
}

// F_n - F = (2/3) (W_sun + S_spline) . e_n / c, with everything else that moves: clearances, tilts, moments.
BOOST_AUTO_TEST_CASE(three_planets_share_by_what_centres_the_sun) {
  test::Verification record("Load sharing of three planets in space", "equilibrium of the sun");
  const test::TemporaryFolder folder("statics_2");
  (void)solved(folder, helical_stage() + in_space());
  const auto forces = table(folder, "mesh_forces.csv"), bearings = table(folder, "bearings.csv");
  const double module = 10e-3 / std::cos(7.5 * units::deg);
  const double base = std::cos(std::atan(std::tan(20 * units::deg) / std::cos(7.5 * units::deg)));
  const double sun = module * 21 / 2 * base, planet = module * 39 / 2 * base;
  const double angle = std::acos((sun + planet) / 0.308), mean = 56875 / (3 * sun);
  const auto names = *bearings.header_value("bearings");
  const auto before = names.substr(0, names.find(" spline"));
  const std::string spline = "bearing" + before.substr(before.find_last_of(' ') + 1);
  BOOST_TEST(forces.rows.size() == 32u);
  double largest = 0;
  for (std::size_t i = 0; i < forces.rows.size(); ++i) {
    const double theta = forces.rows[i][forces.column("carrier_angle_deg")] * units::deg;
    const double x = bearings.rows[i][bearings.column(spline + "_x_N")];
    const double y = bearings.rows[i][bearings.column(spline + "_y_N")] - 180 * 9.80665;
    for (int n = 0; n < 3; ++n) {
      const double along = 2 * pi * n / 3 + pi / 2 - angle + theta;  // of the line of action, in the housing
      const double expected = mean + 2.0 / 3 * (x * std::cos(along) + y * std::sin(along));
      const double force = forces.rows[i][forces.column("sun_planet" + std::to_string(n + 1) + "_force_N")];
      record.close("sun mesh forces at 32 angles of the carrier", "N", force, expected, 1e-8, "residual");
      largest = std::max(largest, std::abs(force / mean - 1));
    }
  }
  BOOST_TEST(largest > 5e-3);  // the spline does push
}

// Turned the other way with everything mirrored, planets 2 and 3 change places and nothing else happens.
BOOST_AUTO_TEST_CASE(mirror_image_turns_the_other_way) {
  test::Verification record("annulus statics of the mirror image", "symmetry");
  const test::TemporaryFolder one("statics_one"), other("statics_other");
  const auto more = [](int side) {
    // Row by row: x, y, z, about x, about y; what couples y with others changes its sign, and so does what couples x
    // with tilts about x.
    std::string matrix;
    const int sign[] = {1, side, 1, side, 1};
    const double values[5][5] = {{3e9, 2e8, 1e7, 1e7, 2e7},
                                 {2e8, 2e9, 2e7, -1e7, 3e7},
                                 {1e7, 2e7, 1e9, 1e6, 2e6},
                                 {1e7, -1e7, 1e6, 2e7, 1e5},
                                 {2e7, 3e7, 2e6, 1e5, 3e7}};
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j)
        matrix += fmt::format("{}{}", i + j > 0 ? ", " : "", values[i][j] * sign[i] * sign[j]);
    return bearing("mount", "ring", "at_mm = 50\nstiffness_5x5_N_m_rad = [" + matrix + "]\n") +
           fmt::format(
               "[[load]]\nname = \"pin\"\nbody = \"planet\"\nplanet = {}\nframe = \"carrier\"\nat_mm = [5, {}, 30]\n"
               "force_N = [2e3, {}, -500]\nmoment_Nm = [{}, 70, 0]\n",
               side > 0 ? 2 : 3, side * 8, side * 1e3, side * 50);
  };
  const auto a = solved(one, helical_stage("7.5", "100") + in_space() + more(1));
  const auto b = solved(other, helical_stage("-7.5", "-100") + in_space("[-50e3, 100e3, 0]", "90") + more(-1));
  for (const std::string key : {"sun_planet_static_load_sharing", "sun_planet_static_face_load_factor",
                                "ring_planet_static_load_sharing", "ring_planet_static_face_load_factor"})
    record.close("load sharing and face load factors", "", result(b, key), result(a, key), 1e-9, "residual");
  const auto first = table(one, "bearings.csv"), second = table(other, "bearings.csv");
  for (std::size_t i = 0; i < first.rows.size(); ++i) {
    BOOST_TEST(first.rows[i][1] == -second.rows[i][1], boost::test_tools::tolerance(1e-12));
    for (const auto& [of_first, of_second] : {std::pair{"bearing1", "bearing1"},
                                              {"bearing2", "bearing3"},
                                              {"bearing7", "bearing7"},
                                              {"bearing9", "bearing9"}})
      for (const auto& [column, sign] : {std::pair{"_x_N", 1}, {"_y_N", -1}, {"_z_N", 1}, {"_about_x_Nm", -1}}) {
        const double expected = first.rows[i][first.column(std::string(of_first) + column)];
        const double found = sign * second.rows[i][second.column(std::string(of_second) + column)];
        record.near("bearing forces over the torque", "N", found, expected, 1e-3, "residual of 2e5 N");
      }
  }
}

// Rigid bodies, a misaligned spur mesh of even stiffness k' per face width: K_Hbeta = 1 + gamma k' b^2 / (2 F) up to 2.
BOOST_AUTO_TEST_CASE(misaligned_spur_stage) {
  test::Verification record("Misaligned stage by annulus statics", "closed form for an even stiffness");
  const test::TemporaryFolder folder("statics_3");
  const double b = 88e-3, k = 2e9 / b,
               force = 2958.8e3 / (1128 * units::rpm) / (5 * 3.8e-3 * 24 * std::cos(22.5 * units::deg));
  for (const double misalignment : {10e-6, 30e-6, 90e-6}) {
    auto scene =
        test::replaced(test::quick_scene(), "stiffness = \"harmonic\"\nmean_N_per_m = 1.364e9\nripple = 0.2258",
                       "stiffness = \"constant\"\nmean_N_per_m = 2e9");
    scene = test::replaced(scene, "stiffness = \"harmonic\"\nmean_N_per_m = 1.87e9\nripple = 0.1294",
                           "stiffness = \"constant\"\nmean_N_per_m = 1.87e9");
    scene = test::replaced(scene, test::quick_errors(),
                           "sun_planet_misalignment_um = " + std::to_string(misalignment / units::um) + "\n");
    const auto statics = solved(folder, scene);
    BOOST_TEST(statics.at("rings").at("held").at("degrees_of_freedom") == "space");
    const double slope = misalignment / b, gentle = 1 + slope * k * b * b / (2 * force);
    const double expected = gentle <= 2 ? gentle : b * std::sqrt(2 * k * slope / force);
    record.close("K_Hbeta of the sun meshes, three misalignments", "",
                 result(statics, "sun_planet_static_face_load_factor"), expected, 1e-8, "residual");
  }
}

/// The helical stage with inertias, a floating sun and [dynamics].
std::string with_dynamics(const std::string& tables) {
  auto scene = helical_stage();
  for (const auto& [mass, inertia] : {std::pair{"mass_kg = 180\n", "inertia_kg_m2 = 1\n"},
                                      {"mass_kg = 110\n", "inertia_kg_m2 = 3\n"},
                                      {"mass_kg = 1500\n", "inertia_kg_m2 = 45\n"},
                                      {"mass_kg = 509\n", "inertia_kg_m2 = 153\n"}})
    scene = test::replaced(scene, mass, std::string(mass) + inertia);
  return scene + tables +
         "[supports]\nsun_N_per_m = \"floating\"\n[dynamics]\nhalf_backlash_um = 300\nmesh_damping_ratio = "
         "0.07\nsupport_damping_ratio = 0.03\n";
}

BOOST_AUTO_TEST_CASE(files_and_warnings) {
  const test::TemporaryFolder folder("statics_4");
  write_file(folder.path() / "scene.toml", helical_stage());
  const auto missing = test::run_program(folder.path(), "statics scene.toml --out out");
  BOOST_TEST(missing.status == 2);
  BOOST_TEST(missing.err.find("supports.sun_N_per_m") != std::string::npos, missing.err);
  write_file(folder.path() / "scene.toml", helical_stage() + "[supports]\nsun_N_per_m = \"floating\"\n");
  const auto held = test::run_program(folder.path(), "statics scene.toml --out out");
  BOOST_TEST(held.status == 0, held.err);
  BOOST_TEST(held.err.find("no [[bearing]] holds the sun, ring, carrier, planets") != std::string::npos, held.err);
  BOOST_TEST(held.out.find("the teeth are helical") != std::string::npos, held.out);
  const auto json = solved(folder, helical_stage() + in_space());
  BOOST_TEST(json.at("rings").at("held").at("reasons_for_space").size() >= 4u);
  BOOST_TEST(json.at("rings").at("held").at("bearings").size() == 10u);
  for (const auto* file : {"mesh_forces.csv", "bearings.csv", "bodies.csv", "face_load_sun_planet.csv"})
    BOOST_TEST(table(folder, file).rows.size() > 20u, file);
  BOOST_TEST(read_file(folder.path() / "out/statics.html").find("Face load factor of the sun meshes") !=
             std::string::npos);
  const auto short_table =
      solved(folder, helical_stage() + in_space() +
                         bearing("guide", "sun", "radial_displacement_um = [0, 1]\nradial_force_N = [0, 1]\n"));
  BOOST_TEST(short_table.at("warnings").dump().find("more than the 1 N at which its table ends") != std::string::npos);
  BOOST_TEST(json.at("warnings").dump().find("table ends") == std::string::npos);
  const auto swept = solved(folder, with_dynamics(in_space()) +
                                        "[[sweep]]\ninput = \"bearing.spline.tilt_Nm_per_rad\"\nfrom = 1e5\nto = "
                                        "1e8\ncount = 2\n");
  BOOST_TEST(swept.at("warnings").dump().find("leaves out [[sweep]] 1") != std::string::npos,
             swept.at("warnings").dump());
  // Nothing holds the sun along the axis: its helix would screw it out.
  const auto loose = test::replaced(helical_stage() + in_space(), "axial_N_per_m = 3e8\n", "");
  write_file(folder.path() / "loose.toml", loose);
  const auto refused = test::run_program(folder.path(), "statics loose.toml --out loose");
  BOOST_TEST(refused.status == 2, refused.err);
  BOOST_TEST(refused.err.find("nothing resists a motion of sun along the axis") != std::string::npos, refused.err);
  write_file(folder.path() / "pair.toml", test::run_program(folder.path(), "new helical_pair").out);
  const auto pair = test::run_program(folder.path(), "statics pair.toml --out pair");
  BOOST_TEST(pair.status == 2);
  BOOST_TEST(pair.err.find("planetary stages alone") != std::string::npos, pair.err);
}

/// Trunnions to the left and right of the ring.
std::string in_mounts(const std::string& keys = "") {
  std::string text;
  for (const auto& [side, x] : {std::pair{"left", -700}, {"right", 700}})
    text += bearing(std::string("trunnion ") + side, "ring",
                    fmt::format("beside_axis_mm = [{}, 20]\nradial_N_per_m = 4e8\naxial_N_per_m = 2e8\n{}", x, keys));
  return text;
}

// The trunnions bear the torque of the ring, its weight and the axial force of its teeth, which the sun takes up.
BOOST_AUTO_TEST_CASE(ring_in_trunnions) {
  test::Verification record("Ring in trunnions by annulus statics", "equilibrium of the ring");
  const test::TemporaryFolder folder("statics_8");
  (void)solved(folder, helical_stage() + in_space() + in_mounts());
  const auto bearings = table(folder, "bearings.csv"), meshes = table(folder, "mesh_forces.csv");
  const auto column = [&](const std::string& name) { return bearings.column(name); };
  const double base = 10e-3 / std::cos(7.5 * units::deg) * 99 / 2 *
                      std::cos(std::atan(std::tan(20 * units::deg) / std::cos(7.5 * units::deg)));
  for (std::size_t i = 0; i < bearings.rows.size(); i += 7) {
    const auto& row = bearings.rows[i];
    const auto on = [&](int bearing, const char* direction) {
      return row[column(fmt::format("bearing{}_{}_N", bearing, direction))];
    };
    double torque = 0;
    for (int n = 1; n <= 3; ++n)
      torque += meshes.rows[i][meshes.column(fmt::format("ring_planet{}_force_N", n))] * base;
    const double found = 0.7 * (on(11, "y") - on(10, "y")) - 0.02 * (on(11, "x") + on(10, "x"));
    record.close("torque of the trunnions on the ring", "N m", found, torque, 1e-6, "residual of the equilibrium");
  }
  const auto refused = [&](const std::string& tables, const std::string& words) {
    write_file(folder.path() / "scene.toml", helical_stage() + in_space() + tables);
    const auto outcome = test::run_program(folder.path(), "check scene.toml");
    BOOST_TEST(outcome.status == 2, outcome.err);
    BOOST_TEST(outcome.err.find(words) != std::string::npos, outcome.err);
  };
  refused(test::replaced(in_mounts(), "beside_axis_mm = [700, 20]", "beside_axis_mm = [700, 20, 0]"),
          "needs two values, x and y, not 3");
  refused(test::replaced(in_mounts(), "body = \"ring\"\nbeside_axis_mm = [700",
                         "body = \"carrier\"\nbeside_axis_mm = [700"),
          "bearing.beside_axis_mm");
  refused(in_mounts("tilt_Nm_per_rad = \"rigid\"\n"), "needs a mount that gives way");
}

BOOST_AUTO_TEST_CASE(degrees_of_motions_in_the_plan) {
  const test::TemporaryFolder folder("statics_7");
  const auto plan_of = [&](const std::string& tables) {
    write_file(folder.path() / "scene.toml", with_dynamics(tables));
    const auto outcome = test::run_program(folder.path(), "plan scene.toml --inputs");
    BOOST_TEST(outcome.status == 0, outcome.err);
    return outcome.out;
  };
  const auto says = [](const std::string& plan, const std::string& dof, const std::string& reason) {
    const auto at = plan.find(dof);
    BOOST_TEST_REQUIRE(at != std::string::npos, dof + " is not in: " + plan);
    BOOST_TEST(plan.substr(at, plan.find('\n', at) - at).find(reason) != std::string::npos, dof + ": " + plan);
  };
  const auto plan = plan_of(in_space());
  says(plan, "retained carrier x, y", "bearing 'upwind', 'downwind'");
  says(plan, "retained carrier z", "bearing 'upwind'");
  says(plan, "retained planet 1 ... 3 z", "bearing 'upwind row'");
  says(plan, "retained sun tilts", "bearing 'spline'");
  says(plan, "dropped  ring z, tilts", "no [[bearing]] holds it");
  BOOST_TEST(plan.find("The lumped model is plane") == std::string::npos);
  // Without [dynamics] those of the statics.
  write_file(folder.path() / "scene.toml", helical_stage() + in_space() + in_mounts());
  const auto statics = test::run_program(folder.path(), "plan scene.toml --inputs");
  BOOST_TEST(statics.status == 0, statics.err);
  says(statics.out, "retained carrier z", "bearing 'upwind'");
  says(statics.out, "dropped  carrier u", "its angle is that of the position");
  says(statics.out, "retained ring u", "bearings beside its axis");
  says(statics.out, "retained planet 1 ... 3 u", "turns");
  BOOST_TEST(plan_of("").find("The lumped model is plane") != std::string::npos);
}

// Planets and carrier on preloaded tapered rollers, the sun's shaft on balls: statics of the bodies.
BOOST_AUTO_TEST_CASE(rolling_elements) {
  annulus::test::Verification record("A stage on tapered rollers and balls", "statics of its bodies");
  const test::TemporaryFolder folder("statics_5");
  const auto rows = [](const std::string& name, const std::string& body, double at, const std::string& keys) {
    const auto one = [&](const char* side, int sign) {
      return bearing(name + side, body,
                     fmt::format("at_mm = {}\ncontact_angle_deg = {}\n{}", sign * at, sign * 14, keys));
    };
    return one(" up", -1) + one(" down", 1);
  };
  constexpr double thrust = 40e3;
  const auto json = solved(
      folder,
      helical_stage() +
          rows("planet", "planet", 60,
               "rollers = 24\nroller_length_mm = 45\nroller_diameter_mm = 30\npitch_diameter_mm = 240\n"
               "clearance_um = -20\n") +
          rows("carrier", "carrier", 280,
               "rollers = 40\nroller_length_mm = 60\nroller_diameter_mm = 40\npitch_diameter_mm = 700\n"
               "clearance_um = -40\n") +
          bearing("shaft", "sun",
                  "at_mm = 700\nballs = 12\nball_diameter_mm = 50\npitch_diameter_mm = 200\nclearance_um = 20\n") +
          bearing("spline", "sun", "radial_N_per_m = 5e7\ntilt_Nm_per_rad = 1e6\n") +
          fmt::format("[[load]]\nname = \"thrust\"\nbody = \"carrier\"\nforce_N = [0, 0, {}]\n", thrust));
  const auto& bearings = json.at("rings").at("held").at("bearings");
  const auto number = [&](const std::string& name) {
    return std::find_if(bearings.begin(), bearings.end(), [&](const auto& b) { return b.at("name") == name; }) -
           bearings.begin();
  };
  const auto axial = [&](const std::string& name) -> double {
    return bearings.at(number(name)).at("axial_force_max_N").at("value");
  };
  // Forces on planets have no axial part: their meshes lean against each other.
  const auto csv = table(folder, "bearings.csv");
  const auto force = [&](const std::string& name) {
    return csv.rows.front().at(csv.column(fmt::format("bearing{}_z_N", number(name) + 1)));
  };
  const double carried = force("carrier up") + force("carrier down");
  record.close("axial force of the carrier's rows", "N", carried, -thrust, 1e-6, "residual of the equilibrium");
  const double planet = force("planet up planet1") + force("planet down planet1");
  record.at_most("axial force of a planet's rows over that of one", "", std::abs(planet) / axial("planet up planet1"),
                 1e-6, "residual of the equilibrium");
  // Sun: F tan(helix) of three meshes, borne by the balls, whose contact angle follows.
  const double helix = 7.5 * units::deg,
               tangent = std::tan(helix) * std::cos(std::atan(std::tan(20 * units::deg) / std::cos(helix)));
  const double mesh_force = json.at("rings").at("held").at("mean_mesh_force_N");
  record.close("axial force of the balls", "N", axial("shaft"), 3 * mesh_force * tangent, 1e-6,
               "residual of the equilibrium");
  for (const auto* name : {"planet up planet1", "carrier down", "shaft"})
    BOOST_TEST(bearings.at(number(name)).at("rolling_element_force_max_N").at("value").get<double>() > 0);
  BOOST_TEST(!bearings.at(number("spline")).contains("rolling_element_force_max_N"));
}

/// The stage on stiff bearings, whose carrier has webs.
std::string stage_with_webs() {
  return helical_stage() +
         "[supports]\nsun_N_per_m = \"floating\"\nplanet_N_per_m = 2e9\nplanet_pin = \"between_walls\"\n"
         "planet_pin_diameter_mm = 120\nplanet_pin_length_mm = 280\n" +
         bearing("spline", "sun", "at_mm = 700\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e6\n") +
         "[carrier_structure]\nwebs = 3\nweb_circle_diameter_mm = 660\nweb_length_mm = 300\nweb_width_mm = 160\n"
         "web_depth_mm = 100\n";
}

// A carrier that winds up tilts the planets, the shaft on one side in the one sense and on the other side in the other.
// The file of its stiffness, made from the beams, says the same as its webs.
BOOST_AUTO_TEST_CASE(a_carrier_that_gives_way) {
  annulus::test::Verification record("Carrier that gives way", "its stiffness as a file; frame of beams");
  const test::TemporaryFolder folder("statics_6");
  const auto about_radial = [&] {
    const auto csv = table(folder, "bodies.csv");
    return csv.rows.front().at(csv.column("planet1_about_x_urad"));
  };
  const auto rigid_webs = solved(folder, test::replaced(stage_with_webs(), "web_width_mm = 160\nweb_depth_mm = 100",
                                                        "web_width_mm = 1e5\nweb_depth_mm = 1e5"));
  const double straight = about_radial();
  const auto other_side = solved(folder, stage_with_webs() + "shaft = \"+z\"\n");
  const double leaning_back = about_radial();
  const auto webs = solved(folder, stage_with_webs());
  const double leaning = about_radial();
  BOOST_TEST((leaning - straight) * (leaning_back - straight) < 0);
  BOOST_TEST(std::abs(leaning - straight) > 10);  // urad
  BOOST_TEST(result(webs, "ring_planet_static_face_load_factor") !=
             result(rigid_webs, "ring_planet_static_face_load_factor"));
  // The same carrier as a matrix in its own axes, with a rotation about the pins that bears nothing.
  dynamics::TwoWallCarrier carrier;
  for (int n = 0; n < 3; ++n) carrier.planet_angles.push_back(2 * pi * n / 3);
  carrier.radius = 0.308;
  carrier.pin = circular_beam(0.12, 206e9, 0.3);
  carrier.pin_length = 0.28;
  carrier.webs = 3;
  carrier.web_radius = 0.33;
  carrier.web_length = 0.3;
  carrier.first_web = pi / 3;
  carrier.web_width = 0.16;
  carrier.web_depth = 0.1;
  carrier.youngs_modulus = 206e9;
  carrier.poisson_ratio = 0.3;
  const auto stiffness = dynamics::pins_stiffness(carrier);
  Eigen::MatrixXd axes = Eigen::MatrixXd::Zero(15, 18);  // own coordinates of every pin from those of the carrier
  Csv csv;
  for (int n = 0; n < 3; ++n) {
    const double c = std::cos(carrier.planet_angles[n]), s = std::sin(carrier.planet_angles[n]);
    axes.block<2, 2>(5 * n, 6 * n) << c, s, -s, c;
    axes(5 * n + 2, 6 * n + 2) = 1;
    axes.block<2, 2>(5 * n + 3, 6 * n + 3) << c, s, -s, c;
    for (const auto* what : {"x_m", "y_m", "z_m", "about_x_rad", "about_y_rad", "about_z_rad"})
      csv.columns.push_back(fmt::format("planet{}_{}", n + 1, what));
  }
  Eigen::MatrixXd all = axes.transpose() * stiffness * axes;
  for (const int n : {5, 11, 17}) all(n, n) = 1e7;
  for (Eigen::Index i = 0; i < 18; ++i) csv.rows.emplace_back(all.row(i).begin(), all.row(i).end());
  csv.write(folder.path() / "carrier.csv");
  auto scene = stage_with_webs();
  scene =
      scene.substr(0, scene.find("[carrier_structure]")) + "[carrier_structure]\nstiffness_file = \"carrier.csv\"\n";
  scene = test::replaced(
      scene, "planet_pin = \"between_walls\"\nplanet_pin_diameter_mm = 120\nplanet_pin_length_mm = 280\n", "");
  const auto file = solved(folder, scene);
  for (const auto* key : {"sun_planet_static_face_load_factor", "ring_planet_static_face_load_factor"})
    record.close("face load factors", "", result(file, key), result(webs, key), 1e-7, "digits of the file");
  record.close("tilt of a planet about the radial axis", "urad", about_radial(), leaning, 1e-7, "digits of the file");
  const auto refused = [&](const std::string& content, const std::string& text) {
    write_file(folder.path() / "carrier.csv", content);
    const auto outcome = test::run_program(folder.path(), "check scene.toml");
    BOOST_TEST(outcome.status == 2);
    BOOST_TEST(outcome.err.find("carrier_structure.stiffness_file") != std::string::npos, outcome.err);
    BOOST_TEST(outcome.err.find(text) != std::string::npos, outcome.err);
  };
  refused("planet1_x_m\n1\n", "has no column planet1_y_m");
}

// A row of rollers with a contact angle holds its body in one direction along the axis. In the other one what is left
// of it in its play would let the carrier go.
BOOST_AUTO_TEST_CASE(a_row_that_is_loaded_the_wrong_way_is_refused) {
  const test::TemporaryFolder folder("statics_8");
  const auto scene = [](double thrust) {
    return helical_stage() +
           bearing("spline", "sun", "radial_N_per_m = 1e9\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e8\n") +
           bearing("planets", "planet", "radial_N_per_m = 2e9\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = 1e8\n") +
           bearing("row", "carrier",
                   "rollers = 30\nroller_length_mm = 40\nroller_diameter_mm = 30\npitch_diameter_mm = 400\n"
                   "contact_angle_deg = 20\n") +
           fmt::format("[[load]]\nname = \"thrust\"\nbody = \"carrier\"\nforce_N = [0, 0, {}]\n", thrust);
  };
  (void)solved(folder, scene(50e3));
  write_file(folder.path() / "scene.toml", scene(-50e3));
  const auto outcome = test::run_program(folder.path(), "statics scene.toml --out out --quiet");
  BOOST_TEST(outcome.status == 2);
  BOOST_TEST(outcome.err.find("the carrier would move by") != std::string::npos, outcome.err);
}

BOOST_AUTO_TEST_CASE(what_contradicts_itself_is_refused) {
  const auto expect_refusal = [](const std::string& tables, const std::string& words) {
    const auto refusal = test::scene_refusal(helical_stage() + tables);
    BOOST_TEST(refusal.find(words) != std::string::npos, words + " is not in: " + refusal);
  };
  expect_refusal(bearing("a", "planet", "on = \"housing\"\nradial_N_per_m = 1e9\n"), "planets stand on the carrier");
  expect_refusal(bearing("a", "carrier", "on = \"carrier\"\nradial_N_per_m = 1e9\n"), "a body cannot stand on itself");
  expect_refusal(bearing("a", "carrier", "on = \"ring\"\nx_N_per_m = 1e9\n"), "the same in all directions");
  expect_refusal(bearing("a", "carrier", "radial_N_per_m = 1e9\nframe = \"carrier\"\n"), "bearing.frame");
  expect_refusal(bearing("a", "carrier", "at_mm = 3\n"), "holds nothing");
  expect_refusal(bearing("a", "carrier", "planet = 1\nradial_N_per_m = 1e9\n"), "other bodies have no numbers");
  expect_refusal(bearing("a", "planet", "planet = 4\nradial_N_per_m = 1e9\n"), "there are 3");
  expect_refusal(bearing("a", "carrier", "radial_N_per_m = 1e9\n") + bearing("a", "carrier", "radial_N_per_m = 1e9\n"),
                 "the name of more than one");
  expect_refusal(bearing("a", "carrier", "radial_N_per_m = \"rigid\"\nclearance_um = 10\n"), "gives way beyond it");
  expect_refusal(bearing("a", "carrier", "radial_N_per_m = 1e9\nx_N_per_m = 1e9\n"), "a value for each direction");
  expect_refusal(bearing("a", "carrier", "stiffness_5x5_N_m_rad = [1, 2]\n"), "needs 25 values");
  expect_refusal(bearing("a", "carrier", "radial_N_per_m = 1e9\nclearance_um = -5\n"),
                 "is a preload, which rolling elements alone have");
  expect_refusal(bearing("a", "carrier", "rollers = 20\nroller_length_mm = 20\n"), "roller_diameter_mm");
  expect_refusal(bearing("a", "carrier", "radial_displacement_um = [0, 10]\nradial_force_N = [0, 0]\n"), "must rise");
  expect_refusal(bearing("a", "carrier", "radial_displacement_um = [0, 10]\n"), "radial_force_N");
  expect_refusal(
      bearing("a", "carrier", "rollers = 20\nroller_length_mm = 20\nroller_diameter_mm = 20\nradial_N_per_m = 1e9\n"),
      "follows from their contact");
  const std::string rollers = "rollers = 20\nroller_length_mm = 20\nroller_diameter_mm = 20\n";
  expect_refusal(bearing("a", "carrier", rollers + "contact_angle_deg = 12\n"), "give bearing.pitch_diameter_mm");
  expect_refusal(bearing("a", "carrier", rollers + "contact_angle_deg = 12\npitch_diameter_mm = 15\n"),
                 "it must be larger");
  expect_refusal(bearing("a", "carrier", rollers + "pitch_diameter_mm = 100\n"), "overlap");
  expect_refusal(
      bearing("a", "carrier", rollers + "contact_angle_deg = 12\npitch_diameter_mm = 300\naxial_N_per_m = 1e9\n"),
      "hold along the axis by themselves");
  expect_refusal(bearing("a", "carrier", rollers + "balls = 12\n"), "one kind of rolling elements");
  expect_refusal(bearing("a", "carrier", "balls = 12\nball_diameter_mm = 20\n"), "pitch_diameter_mm");
  expect_refusal(bearing("a", "carrier", rollers + "inner_groove_ratio = 0.55\n"), "rollers have no grooves");
  expect_refusal("[carrier_structure]\nwebs = 3\n", "web_circle_diameter_mm");
  expect_refusal("[carrier_structure]\nstiffness_file = \"none.csv\"\n", "there is no such file");
  expect_refusal(
      "[carrier_structure]\nwebs = 3\nweb_circle_diameter_mm = 660\nweb_length_mm = 300\nweb_width_mm = 160\n"
      "web_depth_mm = 100\n",
      "clamped in both walls");
  std::string rows = "[";
  for (int i = 0; i < 25; ++i) rows += std::string(i > 0 ? ", " : "") + (i % 6 == 0 ? "1e8" : i == 1 ? "1e7" : "0");
  expect_refusal(bearing("a", "carrier", "stiffness_5x5_N_m_rad = " + rows + "]\n"), "not symmetric");
  expect_refusal("[[load]]\nname = \"a\"\nbody = \"carrier\"\nforce_N = [1, 2]\n", "needs three values");
  expect_refusal("[[load]]\nname = \"a\"\nbody = \"carrier\"\nmoment_Nm = [0, 0, 5]\n", "about z");
  expect_refusal("[[load]]\nname = \"a\"\nbody = \"planet\"\nmoment_Nm = [0, 0, 5]\n",
                 "beside the middle of the planet");
  expect_refusal("[[load]]\nname = \"a\"\nbody = \"carrier\"\n", "force_N");
  const auto weightless =
      test::scene_refusal(test::replaced(helical_stage(), "mass_kg = 180\n", "") + "[gravity]\ndirection_deg = 270\n");
  BOOST_TEST(weightless.find("sun.mass_kg") != std::string::npos, weightless);
}

BOOST_AUTO_TEST_SUITE_END()
