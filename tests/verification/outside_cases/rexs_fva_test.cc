#include <boost/test/unit_test.hpp>
#include <string>

#include "app/export/rexs.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/stage_geometry.h"
#include "core/units.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

namespace {

using namespace annulus;
using test::OutsideCase;
using test::Verification;

}  // namespace

BOOST_AUTO_TEST_SUITE(rexs_fva)

BOOST_AUTO_TEST_CASE(numbers_of_the_sample_file) {
  Verification record("Gear data of a planetary stage from a REXS file",
                      "sample file of the FVA Workbench 5.5, digits as printed (data/cases/rexs_fva)");
  const OutsideCase published("rexs_fva");
  const auto read = app::read_rexs(published.scene("stage.rexs"));
  BOOST_TEST(read.kind == "planetary");
  for (const auto& [key, quantity] : {std::pair{"stage.module_mm", "normal_module"},
                                      {"stage.centre_distance_mm", "center_distance"},
                                      {"sun.teeth", "number_of_teeth_sun"},
                                      {"planet.teeth", "number_of_teeth_planet"},
                                      {"ring.teeth", "number_of_teeth_ring"}}) {
    const auto& printed = published.printed(quantity);
    record.near(std::string("read: ") + quantity, printed.unit, std::stod(read.values.at(key).text), printed.value, 0,
                "exact");
  }
  const auto geometry = app::make_geometry(app::read_scene(published.scene("stage.toml")));
  const auto& mesh = geometry.sun_mesh();
  record.near("working pressure angle of gears without profile shift at that distance", "deg",
              mesh.working_pressure_angle() / units::deg, 20, 1e-9, "rounding");
  const auto& point = geometry.operating_point;
  record.close(
      "torque times speed of the sun", "W", point.power,
      published.printed("torque_sun_shaft").value * published.printed("rotational_speed_sun_shaft").value * units::rpm,
      1e-12, "rounding");
}

BOOST_AUTO_TEST_SUITE_END()
