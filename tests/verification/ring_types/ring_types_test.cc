#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/sections/report_parts.h"
#include "core/files.h"
#include "core/json.h"
#include "core/stiffness_table.h"

namespace {

/// The results of the scene, computed once; the folder is kept for the second run.
struct RingTypes {
  std::filesystem::path out = std::filesystem::temp_directory_path() / "annulus_ring_types_test";

  int run() const {
    const std::string command = std::string("ANNULUS_CACHE= ") + ANNULUS_PROGRAM + " run " + ANNULUS_SOURCE_DIR +
                                "/data/scenes/ring_types.toml --quiet --threads 2 -o " + out.string() + " > /dev/null";
    return std::system(command.c_str());
  }
  annulus::Json summary() const {
    std::ifstream file(out / "summary.json");
    return annulus::Json::parse(file);
  }
};

struct Bar {
  double value = 0, error = 0;
};

Bar stiffness(const annulus::Json& ring) {
  const auto& k = ring.at("ring_planet").at("mean_stiffness_N_per_m");
  const double value = k.at("value");
  return {value, value * k.at("error_relative").get<double>()};
}

Bar sharing(const annulus::Json& ring) {
  const auto& l = ring.at("load_sharing").at("sun_planet").at("averaged");
  return {l.at("value"), l.at("error")};
}

bool clearly_above(const Bar& a, const Bar& b) { return a.value - a.error > b.value + b.error; }

}  // namespace

BOOST_AUTO_TEST_SUITE(ring_types)

BOOST_AUTO_TEST_CASE(scene_to_report) {
  const RingTypes scene;
  std::filesystem::remove_all(scene.out);
  BOOST_TEST_REQUIRE(scene.run() == 0);
  const auto summary = scene.summary();

  const auto& point = summary.at("operating_point");
  BOOST_TEST(std::abs(point.at("sun_torque_N_m").get<double>() - 25048) < 0.5);  // half a unit of the last digit
  BOOST_TEST(std::abs(point.at("mesh_frequency_Hz").get<double>() - 696.1) < 0.05);
  BOOST_TEST(std::abs(point.at("mean_mesh_force_N").get<double>() - 59460) < 5);

  const auto& traditional = summary.at("rings").at("traditional");
  const auto& thin_walled = summary.at("rings").at("thin-walled");
  const auto& pinned = summary.at("rings").at("pinned");
  BOOST_TEST(clearly_above(stiffness(traditional), stiffness(pinned)));
  BOOST_TEST(clearly_above(stiffness(pinned), stiffness(thin_walled)));
  BOOST_TEST(clearly_above(sharing(traditional), sharing(pinned)));
  BOOST_TEST(clearly_above(sharing(pinned), sharing(thin_walled)));

  for (const auto& ring : {traditional, thin_walled, pinned}) {
    BOOST_TEST(ring.at("dynamics").at("steady").get<bool>());
    const auto& invariants = ring.at("invariants");
    BOOST_TEST(invariants.at("force_balance_relative").get<double>() < 1e-9);
    BOOST_TEST(invariants.at("energy_balance_relative").get<double>() < 1e-9);
    BOOST_TEST(invariants.at("closure_relative").get<double>() < 1e-9);
    BOOST_TEST(invariants.at("max_penetration_m").get<double>() < 1e-12);  // a millionth of the deflection
    for (const char* mesh : {"sun_planet", "ring_planet"}) {
      BOOST_TEST(ring.at(mesh).at("worst_error_relative").get<double>() <= summary.at("accuracy_wanted").get<double>());
      BOOST_TEST(ring.at(mesh).at("worst_scaled_jacobian").get<double>() > 0.3);
    }
  }

  constexpr std::uintmax_t largest_page = 4'000'000;
  BOOST_TEST(std::filesystem::file_size(scene.out / "report.html") <= largest_page);

  // What the README prints is what this run gives.
  const auto readme = annulus::read_file(ANNULUS_SOURCE_DIR "/README.md");
  for (const auto& variant : summary.at("variants")) {
    const auto figures = annulus::figure_set_of(variant.at("figures"));
    const auto error = [&](const char* key, double scale) {
      return annulus::app::measured(figures.figure(key), scale);
    };
    const auto spread = [&](const char* key) { return annulus::app::spread_text(*figures.find(key)->spread, 1); };
    const auto row =
        fmt::format("| {} | {} | {} | {} | {} |", error("ring_planet_mean_stiffness_N_per_m", 1e-6),
                    error("ring_planet_lte_peak_to_peak_m", 1e6), spread("sun_planet_load_sharing_averaged"),
                    spread("sun_planet_dynamic_factor"), spread("sun_planet_peak_factor"));
    BOOST_TEST(readme.find(row) != std::string::npos, row);
  }

  // Every tooth of 27 is another place between four of the 24 pins: as many stiff places as pins.
  const auto table = annulus::StiffnessTable::read_csv(scene.out / "pinned" / "stiffness_ring_planet.csv");
  BOOST_TEST_REQUIRE(table.positions() == 27);
  const int nominal = static_cast<int>(table.loads().size()) / 2;
  std::vector<double> by_tooth;
  for (int tooth = 0; tooth < table.positions(); ++tooth) {
    double mean = 0;
    for (int phase = 0; phase < table.phases(); ++phase)
      mean += table.at(tooth, phase, nominal).stiffness_secant / table.phases();
    by_tooth.push_back(mean);
  }
  int maxima = 0;
  for (std::size_t i = 0; i < by_tooth.size(); ++i) {
    const double before = by_tooth[(i + by_tooth.size() - 1) % by_tooth.size()];
    const double after = by_tooth[(i + 1) % by_tooth.size()];
    maxima += by_tooth[i] > before && by_tooth[i] >= after;
  }
  BOOST_TEST(maxima == 4);
  BOOST_TEST(*std::max_element(by_tooth.begin(), by_tooth.end()) >
             4.0 / 3.0 * *std::min_element(by_tooth.begin(), by_tooth.end()));

  // A second run, which does not know that the first one came to its end, reuses everything and tells the same.
  std::filesystem::remove(scene.out / "run.json");
  BOOST_TEST_REQUIRE(scene.run() == 0);
  const auto again = scene.summary();
  for (const auto& [name, ring] : again.at("rings").items()) {
    BOOST_TEST(ring.at("ring_planet").at("reused").get<bool>());
    BOOST_TEST(sharing(ring).value == sharing(summary.at("rings").at(name)).value);
  }
  std::filesystem::remove_all(scene.out);
}

BOOST_AUTO_TEST_SUITE_END()
