#include "core/result_store.h"

#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/log.h"
#include "fem/body/gear_body.h"
#include "fem/contact/support_row.h"
#include "fem/problem/superelement_cache.h"
#include "fem/ring/ring_coupling.h"
#include "ring_paper_problems.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(condensed_store)

using namespace annulus::tests;
using annulus::ResultStore;
using annulus::fem::BodyStress;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshResult;
using annulus::fem::LoadedMeshSettings;
using annulus::fem::OutsideHeld;

/// Kept teeth in a folder of their own for each case.
struct Folder : annulus::test::TemporaryFolder {
  explicit Folder(const std::string& name) : TemporaryFolder("store_" + name) {
    annulus::log::set_level(annulus::log::Level::quiet);
  }

  [[nodiscard]] std::shared_ptr<ResultStore> store(const std::string& version = "1") const {
    return std::make_shared<ResultStore>(path(), version);
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> result;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path()))
      if (entry.is_regular_file()) result.push_back(entry.path());
    return result;
  }
};

LoadedMeshResult solve(const LoadedMeshProblem& problem, std::shared_ptr<ResultStore> store) {
  LoadedMeshSettings settings;
  settings.level = 1;
  settings.threads = 2;
  settings.store = std::move(store);
  return solve_loaded_mesh(problem, settings);
}

template <class Stress>
bool differ(const std::optional<Stress>& a, const std::optional<Stress>& b) {
  if (!a || !b) return a.has_value() != b.has_value();
  return a->root_von_mises != b->root_von_mises || a->rim_von_mises != b->rim_von_mises;
}

const char* const same_bits = "equal to the last bit";

/// Stresses and supports too, which take other ways than the flanks.
void check_the_same(annulus::test::Verification& record, const LoadedMeshResult& a, const LoadedMeshResult& b) {
  check_identical(a, b);
  record.at_most("transmission error, largest relative difference", "", largest_lte_difference(a, b), 0, same_bits);
  int different = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    const auto &p = a.positions[i], &q = b.positions[i];
    different += differ(p.wheel_stress, q.wheel_stress) || differ(p.pinion_stress, q.pinion_stress) ||
                 p.pins.size() != q.pins.size();
    for (std::size_t pin = 0; pin < p.pins.size(); ++pin)
      different += p.pins[pin].radial_force != q.pins[pin].radial_force ||
                   p.pins[pin].tangential_force != q.pins[pin].tangential_force;
  }
  record.at_most("stresses and forces on supports that differ", "", different, 0, same_bits);
}

/// Teeth that were condensed or read from the store: one of each body on each of two levels.
void count_teeth(annulus::test::Verification& record, const std::string& which, int found, int expected) {
  record.near(which, "", found, expected, 0, "counted by hand");
}

BOOST_AUTO_TEST_CASE(a_cached_tooth_changes_not_a_single_bit) {
  const Folder folder("bits");
  annulus::test::Verification record("Results with cached teeth", "the same without a store");
  for (const auto& problem : {ring_mesh(OutsideHeld{}, 2), ring_mesh(paper_pins(81, 0.01), 2)}) {
    const auto without = solve(problem, nullptr);
    count_teeth(record, "teeth condensed without a store", without.condensed_teeth, 4);
    count_teeth(record, "teeth read without a store", without.reused_teeth, 0);
    const auto making = solve(problem, folder.store());
    const auto reading = solve(problem, folder.store());
    count_teeth(record, "teeth condensed or read at first", making.condensed_teeth + making.reused_teeth, 4);
    count_teeth(record, "teeth condensed the second time", reading.condensed_teeth, 0);
    count_teeth(record, "teeth read the second time", reading.reused_teeth, 4);
    check_the_same(record, without, making);
    check_the_same(record, without, reading);
  }
}

BOOST_AUTO_TEST_CASE(the_planet_of_all_meshes_is_one_tooth) {
  const Folder folder("planet");
  const auto store = folder.store();
  annulus::test::Verification record("Teeth cached for the meshes of a stage",
                                     "counted by hand: sun, planet, ring held outside, ring that floats");
  count_teeth(record, "teeth condensed for the sun mesh", solve(sun_mesh(2), store).condensed_teeth, 4);
  const auto held = solve(ring_mesh(OutsideHeld{}, 2), store);
  count_teeth(record, "teeth condensed for the ring mesh: the ring", held.condensed_teeth, 2);
  count_teeth(record, "teeth read for the ring mesh: the planet", held.reused_teeth, 2);
  const auto pinned = solve(ring_mesh(paper_pins(81, 0), 2), store);
  count_teeth(record, "teeth condensed for pins: a ring that floats is another body", pinned.condensed_teeth, 2);
  record.near("files stored", "", static_cast<double>(folder.files().size()), 8, 0, "one for each tooth");
}

BOOST_AUTO_TEST_CASE(other_supports_condense_nothing) {
  const Folder folder("pins");
  annulus::test::Verification record("Other pins, bolts, a housing and splines on a cached ring",
                                     "the same without a store");
  const auto store = folder.store();
  (void)solve(ring_mesh(paper_pins(81, 0), 2), store);
  auto stiffer = paper_pins(54, 0.013);
  stiffer.radial_stiffness = 5e9;
  stiffer.clearance = 5e-6;
  auto bolted = paper_pins(81, 0.003);
  bolted.unilateral = false;
  bolted.pin_diameter *= 0.8;
  auto housed = paper_pins(81, 0);
  housed.housing_clearance = 10e-6;
  annulus::fem::SplineHeld spline;
  spline.teeth = 81;
  spline.flank_angle = 0.5;
  for (const annulus::fem::RingStructure& structure :
       std::vector<annulus::fem::RingStructure>{stiffer, bolted, housed, spline}) {
    const auto problem = ring_mesh(structure, 2);
    const auto reused = solve(problem, store);
    count_teeth(record, "teeth condensed", reused.condensed_teeth, 0);
    count_teeth(record, "teeth read", reused.reused_teeth, 4);
    check_the_same(record, solve(problem, nullptr), reused);
  }
}

BOOST_AUTO_TEST_CASE(loads_positions_and_modifications_condense_nothing) {
  const Folder folder("loads");
  annulus::test::Verification record("Other loads, positions and a tip relief on cached teeth",
                                     "the same without a store");
  const auto store = folder.store();
  (void)solve(ring_mesh(OutsideHeld{}, 2), store);
  auto problem = ring_mesh(OutsideHeld{}, 3, {nominal_load / 2, nominal_load});
  count_teeth(record, "teeth condensed for other loads and positions", solve(problem, store).condensed_teeth, 0);
  const auto relieved = [](const annulus::geometry::Gear& gear) {
    auto parameters = gear.parameters();
    parameters.tip_relief = 20e-6;
    parameters.tip_relief_length = 3e-3;
    return annulus::geometry::Gear(parameters);
  };
  problem.pair = {relieved(problem.pair.pinion()), problem.pair.wheel(), problem.pair.centre_distance()};
  const auto reused = solve(problem, store);
  count_teeth(record, "teeth condensed for a tip relief", reused.condensed_teeth, 0);
  check_the_same(record, solve(problem, nullptr), reused);
}

BOOST_AUTO_TEST_CASE(what_a_tooth_depends_on_condenses_it_again) {
  const Folder folder("depends");
  annulus::test::Verification record("Inputs on which a cached tooth depends",
                                     "counted by hand: the teeth that a change concerns");
  const auto problem = ring_mesh(OutsideHeld{}, 2);
  (void)solve(problem, folder.store());
  auto changed = problem;
  changed.materials.wheel.youngs_modulus *= 1.01;
  count_teeth(record, "teeth condensed for another material of the ring",
              solve(changed, folder.store()).condensed_teeth, 2);
  changed.materials.pinion.youngs_modulus *= 1.01;
  count_teeth(record, "teeth condensed for another material of the planet",
              solve(changed, folder.store()).condensed_teeth, 2);
  changed = problem;
  changed.wheel_support_radius += 1e-3;
  count_teeth(record, "teeth condensed for another ring", solve(changed, folder.store()).condensed_teeth, 2);
  changed = problem;
  changed.pinion_bore_radius -= 1e-3;
  count_teeth(record, "teeth condensed for another planet", solve(changed, folder.store()).condensed_teeth, 2);
  LoadedMeshSettings cubic;
  cubic.level = 1;
  cubic.degree = 3;
  cubic.store = folder.store();
  count_teeth(record, "teeth condensed for cubic elements", solve_loaded_mesh(problem, cubic).condensed_teeth, 4);
}

BOOST_AUTO_TEST_CASE(a_solid_tooth_on_pins_is_cached) {
  const Folder folder("solid");
  const auto store = folder.store();
  const auto problem = ring_mesh(OutsideHeld{}, 2);
  const annulus::geometry::ToothProfile profile(problem.pair.wheel());
  annulus::geometry::SectorResolution coarse;
  coarse.flank_cells = 3;
  coarse.fillet_cells = 2;
  coarse.thickness_cells = 4;
  coarse.root_cells = 1;
  coarse.rim_cells = 2;
  const double width = problem.face_width;
  const auto mesh = annulus::geometry::extrude(
      annulus::geometry::make_sector_mesh(profile.gear(), {ring_outside, {}}, coarse), {{0, width, 2}});
  annulus::fem::GearBodyOptions options;
  options.sector.held = annulus::fem::HeldBoundary::none;
  options.sector.flank = annulus::geometry::Boundary::trailing_flank;
  options.sector.outputs = {annulus::fem::SectorOutput::outside, annulus::fem::SectorOutput::stress};
  annulus::test::Verification record("A solid tooth cached for 81, 54 and 24 pins", "the same condensed afresh");
  const auto same = [&](const char* quantity, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    record.at_most(quantity, "", static_cast<double>((a.array() != b.array()).count()), 0, same_bits);
  };
  bool first = true;
  for (const auto& [pins, slices] : {std::pair{81, 2}, {54, 2}, {24, 2}, {24, 1}}) {
    std::vector<double> edges = {0, width};
    if (slices == 2) edges.insert(edges.begin() + 1, width / 2);
    const auto sites = paper_pins(pins, 0.01).supports({162, ring_outside, width, problem.materials.wheel});
    options.arcs = annulus::fem::SupportPlan(sites, 162, edges).arcs();
    options.store = store.get();
    const auto cached = condense_tooth(mesh, profile, ring_outside, problem.materials.wheel, options);
    options.store = nullptr;
    const auto fresh = condense_tooth(mesh, profile, ring_outside, problem.materials.wheel, options);
    BOOST_TEST(cached.reused == (!first && slices == 2));  // other slices are other unit loads
    first = false;
    BOOST_TEST(cached.body.acting_wrenches.size() == options.arcs.size());
    same("entries of the stiffness of the cuts that differ", cached.sector.interface_stiffness,
         fresh.sector.interface_stiffness);
    same("entries of the loads on the cuts that differ", cached.sector.interface_load, fresh.sector.interface_load);
    same("entries of the compliance that differ", cached.sector.compliance, fresh.sector.compliance);
    BOOST_TEST(cached.body.rim.first_load == fresh.body.rim.first_load);
    BOOST_TEST(cached.sector.compliance.rows() == fresh.body.rim.first_load + fresh.body.rim.loads());
    for (std::size_t arc = 0; arc < options.arcs.size(); ++arc)
      BOOST_TEST((cached.body.acting_wrenches[arc] == fresh.body.acting_wrenches[arc]));
  }
}

BOOST_AUTO_TEST_CASE(a_damaged_tooth_is_condensed_again) {
  const Folder folder("tooth");
  annulus::test::Verification record("A cached tooth whose file was cut off", "the result before the damage");
  const auto problem = ring_mesh(OutsideHeld{}, 2);
  const auto first = solve(problem, folder.store());
  const auto damaged = folder.files().front();
  std::filesystem::resize_file(damaged, std::filesystem::file_size(damaged) * 2 / 3);
  const auto again = solve(problem, folder.store());
  count_teeth(record, "teeth condensed again", again.condensed_teeth, 1);
  count_teeth(record, "teeth read", again.reused_teeth, 3);
  check_the_same(record, first, again);
}

BOOST_AUTO_TEST_CASE(the_folder_keeps_to_its_size) {
  const Folder folder("size");
  annulus::test::Verification record("A store that is full, has no room or no folder",
                                     "its limit; the result without a store");
  const auto bytes = [&] {
    std::uintmax_t sum = 0;
    for (const auto& file : folder.files()) sum += std::filesystem::file_size(file);
    return sum;
  };
  const auto problem = ring_mesh(OutsideHeld{}, 2);
  (void)solve(problem, folder.store());
  const auto all = bytes();
  // Another material would need as much again.
  auto changed = problem;
  changed.materials.pinion.poisson_ratio = changed.materials.wheel.poisson_ratio = 0.28;
  const auto tight = std::make_shared<ResultStore>(folder.path(), "1", all);
  count_teeth(record, "teeth condensed for another material", solve(changed, tight).condensed_teeth, 4);
  record.at_most("size of the folder over its limit", "", static_cast<double>(bytes()) / static_cast<double>(all), 1,
                 "the limit");
  count_teeth(record, "teeth condensed the second time: what was used last stays",
              solve(changed, tight).condensed_teeth, 0);
  // No room at all, or no folder: nothing is stored, and nothing fails.
  const auto no_room = std::make_shared<ResultStore>(folder.path(), "1", 10);
  count_teeth(record, "teeth condensed without room", solve(problem, no_room).condensed_teeth, 4);
  BOOST_TEST(folder.files().empty());
  std::ofstream(folder.path() / "file") << "no folder";
  const auto nowhere = std::make_shared<ResultStore>(folder.path() / "file", "1");
  check_the_same(record, solve(problem, nowhere), solve(problem, nullptr));
}

BOOST_AUTO_TEST_CASE(the_coupling_of_a_ring_on_other_pins_condenses_nothing) {
  const Folder folder("coupling");
  annulus::test::Verification record("Coupling and modes of a cached ring, on other pins", "the same without a store");
  annulus::fem::RingCouplingSettings settings;
  settings.store = folder.store();
  const auto first = solve_ring_coupling(ring_mesh(paper_pins(81, 0), 2), equal_places(5), nominal_load, settings);
  count_teeth(record, "teeth condensed at first", first.condensed_teeth, 2);
  const auto problem = ring_mesh(paper_pins(54, 0.01), 2);
  const auto reused = solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
  count_teeth(record, "teeth condensed for other pins", reused.condensed_teeth, 0);
  count_teeth(record, "teeth read for other pins", reused.reused_teeth, 2);
  settings.store = nullptr;
  const auto without = solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
  BOOST_TEST_REQUIRE(reused.coupling.compliance.size() == without.coupling.compliance.size());
  for (std::size_t i = 0; i < without.coupling.compliance.size(); ++i)
    record.at_most("compliance, largest difference", "m/N",
                   (reused.coupling.compliance[i] - without.coupling.compliance[i]).cwiseAbs().maxCoeff(), 0,
                   same_bits);
  BOOST_TEST_REQUIRE(reused.coupling.modes.size() == without.coupling.modes.size());
  for (std::size_t i = 0; i < without.coupling.modes.size(); ++i)
    record.near("frequency of a mode", "Hz", reused.coupling.modes[i].frequency, without.coupling.modes[i].frequency, 0,
                same_bits);
}

BOOST_AUTO_TEST_SUITE_END()
