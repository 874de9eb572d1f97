#include "geometry/flank_topography.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/files.h"
#include "core/units.h"
#include "gears.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(flank_topography)

using namespace annulus::geometry;
namespace units = annulus::units;

namespace {

const std::vector<double> radii = {0.100, 0.102, 0.103, 0.105, 0.106};
const std::vector<double> positions = {-0.02, -0.01, 0.005, 0.015, 0.02};

Eigen::MatrixXd grid(const std::function<double(double, double)>& removed, std::size_t columns) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(radii.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < radii.size(); ++i)
    for (std::size_t j = 0; j < columns; ++j)
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = removed(radii[i], positions[j]);
  return values;
}

double plane(double r, double z) { return 2e-3 * (r - 0.1) - 5e-4 * z; }

}  // namespace

BOOST_AUTO_TEST_CASE(planes_are_interpolated_exactly) {
  const FlankTopography flank(radii, positions, grid(plane, positions.size()));
  BOOST_TEST(flank.varies_along_face());
  const auto slice = flank.slice(-0.013, 0.004);
  for (const double r : {0.1, 0.1013, 0.1047, 0.106}) {
    BOOST_TEST(std::abs(slice.mean(r) - plane(r, -0.0045)) < 1e-16);
    for (int k = 0; k < FlankTopography::slice_places; ++k)
      BOOST_TEST(std::abs(slice.across.at(static_cast<std::size_t>(k))(r) -
                          plane(r, -0.013 + 0.017 * k / (FlankTopography::slice_places - 1))) < 1e-16);
  }
  // Beyond the grid its ends hold.
  BOOST_TEST(slice.mean(0.09) == slice.mean(0.1));
  BOOST_TEST(slice.mean(0.2) == slice.mean(0.106));
  BOOST_TEST(std::abs(flank.slice(0.03, 0.04).mean(0.1) - plane(0.1, 0.02)) < 1e-16);
}

BOOST_AUTO_TEST_CASE(one_profile_is_that_of_the_whole_face) {
  const FlankTopography flank(radii, {0.0}, grid([](double r, double) { return r - 0.1; }, 1));
  BOOST_TEST(!flank.varies_along_face());
  const auto slice = flank.slice(-0.01, 0.01);
  BOOST_TEST(std::abs(slice.mean(0.1031) - 0.0031) < 1e-16);
  BOOST_TEST(slice.across.empty());
  BOOST_TEST(FlankCurve()(0.1) == 0);
}

BOOST_AUTO_TEST_CASE(grids_that_cannot_be_interpolated_are_refused) {
  using annulus::geometry::test::check_refused;
  const auto values = grid(plane, positions.size());
  check_refused([&] { FlankTopography({0.1, 0.2, 0.3}, {0.0}, values.block(0, 0, 3, 1)); }, "4 diameters, and has 3");
  check_refused([&] { FlankTopography(radii, {0.0, 0.01}, values.leftCols(2)); }, "or one, and has 2");
  check_refused([&] { FlankTopography({0.1, 0.1, 0.103, 0.105, 0.106}, positions, values); }, "have to rise");
  check_refused([&] { FlankTopography(radii, positions, values.leftCols(2)); }, "5 x 2 values");
  auto holes = values;
  holes(2, 2) = std::numeric_limits<double>::quiet_NaN();
  check_refused([&] { FlankTopography(radii, positions, holes); }, "not finite");
}

BOOST_AUTO_TEST_CASE(files_have_a_row_for_every_point) {
  const annulus::test::TemporaryFolder folder("flank_topography");
  const auto file = folder.path() / "flank.csv";
  const auto read = [&](const std::string& text) {
    annulus::write_file(file, text);
    return read_flank_topography(file);
  };
  const std::string head = "position_mm,removed_um,diameter_mm\n";
  // Rows in any order; another file may have more columns.
  const auto flank = read(head + "0,4,206\n0,1,200\n0,2,202\n0,3,204\n");
  BOOST_TEST(flank.radii().front() == 0.1);
  BOOST_TEST(flank.removed()(3, 0) == 4 * units::um);
  const auto says = [&](const std::string& text, const std::string& part) {
    BOOST_CHECK_EXCEPTION((void)read(text), annulus::InputError, [&](const auto& e) {
      const std::string message = e.what();
      BOOST_TEST_MESSAGE(message);
      return message.find(part) != std::string::npos && message.find("flank.csv") != std::string::npos;
    });
  };
  says(head + "0,4,206\n0,1,200\n0,2,202\n", "4 diameters");
  says(head + "0,4,206\n0,1,200\n0,2,202\n1,3,204\n", "diameter_mm = 200 and position_mm = 1 is missing");
  says(head + "0,4,206\n0,4,206\n", ":3: the point at diameter_mm = 206 and position_mm = 0 stands there twice");
  says(head + "0,4000,206\n", ":2: removed_um is 4000");
  says(head + "0,4,-206\n", ":2: diameter_mm has to be above zero");
  says("position_mm,removed_um\n0,4\n", "diameter_mm");
}

BOOST_AUTO_TEST_SUITE_END()
