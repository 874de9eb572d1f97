#include "core/ring_coupling.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/files.h"
#include "core/floating_point.h"

BOOST_AUTO_TEST_SUITE(ring_coupling_file)

using annulus::InputError;
using annulus::RingCoupling;
using annulus::RingMode;

const auto folder = std::filesystem::temp_directory_path();
const auto compliance_file = folder / "annulus_ring_coupling_test.csv";
const auto modes_file = folder / "annulus_ring_coupling_test_modes.csv";

RingCoupling sample(int planets, int teeth, int positions, int per_cycle, int modes) {
  RingCoupling c;
  c.planets = planets;
  c.ring_teeth = teeth;
  c.load = 59460 / 3.0;
  c.per_cycle = per_cycle;
  c.mass = 100.0 / 3;
  c.rotational_mass = 113.0 / 3;
  for (int i = 0; i < positions * per_cycle; ++i) {
    Eigen::MatrixXd m(planets, planets);
    for (int n = 0; n < planets; ++n)
      for (int k = 0; k < planets; ++k) m(n, k) = 1e-11 / (3 + i + (n - k) * (n - k)) - (n == k ? 1e-12 : 0);
    c.compliance.push_back(m);
  }
  for (int k = 0; k < modes; ++k) {
    RingMode mode{1000.0 / 3 + 100 * k, k % (teeth / 2), {}, 0.1 * k, -0.2 / 3, 1.0 / 7};
    for (int t = 0; t < teeth; ++t) mode.deflection.push_back(std::cos(t * k) / 3);
    c.modes.push_back(mode);
  }
  return c;
}

RingCoupling written_and_read(const RingCoupling& coupling) {
  coupling.write_csv(compliance_file, modes_file);
  return RingCoupling::read_csv(compliance_file, modes_file);
}

std::string message_after_editing(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  sample(2, 6, 3, 2, 2).write_csv(compliance_file, modes_file);
  auto edited = annulus::read_file(file);
  BOOST_TEST_REQUIRE(edited.find(from) != std::string::npos);
  edited.replace(edited.find(from), from.size(), to);
  annulus::write_file(file, edited);
  try {
    (void)RingCoupling::read_csv(compliance_file, modes_file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

BOOST_AUTO_TEST_CASE(round_trip_keeps_every_bit) {
  for (const auto& [planets, teeth, positions, per_cycle, modes] :
       {std::tuple{1, 3, 1, 1, 0}, {5, 162, 27, 1, 3}, {3, 12, 1, 4, 1}, {4, 12, 6, 2, 5}}) {
    auto coupling = sample(planets, teeth, positions, per_cycle, modes);
    coupling.provenance = {{"annulus_version", "0"}, {"model", "plane"}};
    const auto read = written_and_read(coupling);
    BOOST_TEST(read.planets == planets);
    BOOST_TEST(read.ring_teeth == teeth);
    BOOST_TEST(read.load == coupling.load);
    BOOST_TEST(read.mass == coupling.mass);
    BOOST_TEST(read.rotational_mass == coupling.rotational_mass);
    BOOST_TEST(read.per_cycle == per_cycle);
    BOOST_TEST((read.provenance == coupling.provenance));
    BOOST_TEST_REQUIRE(read.compliance.size() == coupling.compliance.size());
    for (std::size_t i = 0; i < read.compliance.size(); ++i)
      BOOST_TEST((read.compliance[i].array() == coupling.compliance[i].array()).all());
    BOOST_TEST_REQUIRE(read.modes.size() == coupling.modes.size());
    for (std::size_t k = 0; k < read.modes.size(); ++k) {
      const auto &a = read.modes[k], &b = coupling.modes[k];
      BOOST_TEST((a.frequency == b.frequency && a.waves == b.waves && a.deflection == b.deflection &&
                  a.translation_x == b.translation_x && a.translation_y == b.translation_y &&
                  a.rotation == b.rotation));
    }
  }
  std::filesystem::remove(compliance_file);
  std::filesystem::remove(modes_file);
}

BOOST_AUTO_TEST_CASE(a_damaged_file_is_refused_with_its_line) {
  const annulus::UntrappedFloatingPoint untrapped;  // values that are no numbers
  // Six header lines, then the columns, then rows.
  const auto refused = [](const std::filesystem::path& file, const std::string& from, const std::string& to, int line) {
    const auto message = message_after_editing(file, from, to);
    BOOST_TEST(message.starts_with(file.string() + ":" + std::to_string(line) + ":"), message);
  };
  refused(compliance_file, "# planets: 2", "# planets: 2.5", 1);
  refused(compliance_file, "# planets: 2", "# planets: two", 1);
  refused(compliance_file, "# planets: 2", "# planets: 3", 7);  // columns are missing
  refused(compliance_file, "# load_N", "# load", 1);
  refused(compliance_file, "# load_N: 1", "# load_N: -1", 1);
  refused(compliance_file, "# per_cycle: 2", "# per_cycle: 4", 1);  // 6 positions
  refused(compliance_file, "# ring_teeth: 6", "# ring_teeth: 7", 1);
  refused(compliance_file, "compliance_2_1_m_per_N", "compliance_2_1", 7);
  refused(compliance_file, "\n0.5,", "\n0.6,", 9);
  refused(compliance_file, "\n1,", "\nnan,", 10);
  refused(compliance_file, "\n0,", "\n0,0,1e-12,2e-12,0\n0,", 1);  // a position too many
  refused(modes_file, "# ring_teeth: 6", "# ring_teeth: 8", 1);
  refused(modes_file, "deflection_5_per_sqrt_kg", "deflection_6_per_sqrt_kg", 7);
  refused(modes_file, "\n433.3", "\n133.3", 9);  // frequencies fall
  refused(modes_file, "\n333.3", "\n-333.3", 8);
  refused(modes_file, ",0,0,", ",4,0,", 8);  // more than half as many waves as teeth
  refused(modes_file, ",0,0,", ",0.5,0,", 8);
  const auto unsymmetric = message_after_editing(compliance_file, "\n0,", "\n0,1e-12,1e-12,2e-12,1e-12\n0,");
  BOOST_TEST(unsymmetric != "accepted");
  std::filesystem::remove(compliance_file);
  std::filesystem::remove(modes_file);
}

BOOST_AUTO_TEST_CASE(unusable_values_are_not_written) {
  const auto good = sample(2, 6, 3, 1, 2);
  BOOST_CHECK_NO_THROW(good.write_csv(compliance_file, modes_file));
  const auto refused = [&](auto change) {
    auto bad = good;
    change(bad);
    BOOST_CHECK_THROW(bad.write_csv(compliance_file, modes_file), InputError);
  };
  refused([](RingCoupling& c) { c.compliance[1](0, 1) *= 1.01; });
  refused([](RingCoupling& c) { c.compliance[1](0, 0) = std::numeric_limits<double>::quiet_NaN(); });
  refused([](RingCoupling& c) { c.compliance[2] = Eigen::MatrixXd::Zero(3, 3); });
  refused([](RingCoupling& c) { c.compliance.pop_back(), c.compliance.pop_back(), c.ring_teeth = 0; });
  refused([](RingCoupling& c) { c.compliance.clear(); });
  refused([](RingCoupling& c) { c.load = 0; });
  refused([](RingCoupling& c) { c.per_cycle = 2; });  // three positions
  refused([](RingCoupling& c) { c.modes[0].deflection.pop_back(); });
  refused([](RingCoupling& c) { std::swap(c.modes[0], c.modes[1]); });
  refused([](RingCoupling& c) { c.modes[1].deflection[3] = std::numeric_limits<double>::infinity(); });
  refused([](RingCoupling& c) { c.modes[1].waves = -1; });
  std::filesystem::remove(compliance_file);
  std::filesystem::remove(modes_file);
}

BOOST_AUTO_TEST_SUITE_END()
