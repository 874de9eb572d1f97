#include "app/systems/planetary/strain_gauges.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/scene/scene_declare.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/ring_structures.h"
#include "core/not_known.h"
#include "core/units.h"
#include "dynamics/systems/planetary/gauge_strain.h"

namespace annulus::app {

namespace {

using Place = fem::StrainGauge::Place;
using Direction = fem::StrainGauge::Direction;

constexpr double micro = 1e-6;

bool is_on(const StrainGaugeInput& gauge, const RingInput& ring) { return !gauge.ring || *gauge.ring == ring.name; }

std::string name_at(const StrainGaugeInput& gauge, double axial_position) {
  if (gauge.axial_positions.size() < 2) return gauge.name;
  return fmt::format("{}, z = {:.6g} mm", gauge.name, axial_position / units::mm);
}

/// In the middle of the face without a list.
std::vector<double> positions_of(const StrainGaugeInput& gauge) {
  return gauge.axial_positions.empty() ? std::vector<double>{0} : gauge.axial_positions;
}

class GaugeChecks : KeyChecks {
 public:
  using KeyChecks::KeyChecks;

  void run() {
    if (!planetary(scene_).strain_gauges.empty() &&
        (scene_.fidelity == Fidelity::closed_form || scene_.fidelity == Fidelity::resolved))
      problem("model",
              "has no whole ring that gauges could stand on ([[strain_gauge]]); use \"automatic\", \"plane\" or "
              "\"solid\"");
    for (std::size_t i = 0; i < planetary(scene_).strain_gauges.size(); ++i) {
      const auto& gauge = planetary(scene_).strain_gauges[i];
      if (usable("strain_gauge.name", i)) name(i, gauge.name);
      const auto named = [&](const auto& ring) { return gauge.ring && ring.name == *gauge.ring; };
      if (gauge.ring && std::none_of(planetary(scene_).rings.begin(), planetary(scene_).rings.end(), named))
        problem("strain_gauge.ring", i, "is the name of no ring (ring.name)");
      if (!usable("strain_gauge.place", i) || !usable("strain_gauge.angle_deg", i)) continue;
      if (gauge.place == Place::outside)
        outside(i, gauge);
      else
        root(i, gauge);
    }
  }

 private:
  void name(std::size_t i, const std::string& name) {
    const auto printable = [](unsigned char c) { return c >= ' ' && c != 127; };
    if (name.empty() || !std::all_of(name.begin(), name.end(), printable))
      return problem("strain_gauge.name", i, "names a gauge in tables: not empty, without line breaks and tabs");
    for (std::size_t j = 0; j < i; ++j)
      if (planetary(scene_).strain_gauges[j].name == name)
        return problem("strain_gauge.name", i, "is the name of more than one gauge; each needs its own");
  }

  void root(std::size_t i, const StrainGaugeInput& gauge) {
    constexpr double clear = 0.01;  // of a pitch
    for (const auto& ring : planetary(scene_).rings) {
      if (!is_on(gauge, ring) || !usable("ring.teeth", ring.name)) continue;
      const double teeth = gauge.angle * ring.teeth / (2 * std::numbers::pi);
      if (std::abs(std::remainder(teeth, 1)) < clear)
        problem("strain_gauge.angle_deg", i,
                fmt::format("is the middle of a tooth of ring '{}', with a root on either side; add or subtract half a "
                            "pitch ({:.6g} degrees)",
                            ring.name, 180.0 / ring.teeth));
    }
  }

  void outside(std::size_t i, const StrainGaugeInput& gauge) {
    for (const auto& ring : planetary(scene_).rings)
      if (is_on(gauge, ring) && fem::held_outside(ring_structure(ring)))
        problem(
            "strain_gauge.place", i,
            fmt::format("is not possible on ring '{}', whose outside is fixed and has no free surface; use \"root\" or "
                        "name another ring (strain_gauge.ring)",
                        ring.name));
  }
};

}  // namespace

Table strain_gauge_table() {
  Declarations gauge(
      "strain_gauge",
      "A strain gauge on the ring: its strain over a revolution of the carrier. Several tables are several "
      "gauges.",
      &PlanetaryInput::strain_gauges);
  gauge.on_request().only_if(is("mesh.ring_planet.stiffness", {"computed"}),
                             "a prescribed stiffness has no ring that is strained");
  gauge.key("name", &StrainGaugeInput::name, "Name of the gauge in results.").required();
  gauge.key("ring", &StrainGaugeInput::ring, "The ring that carries it.").absent("every ring");
  gauge
      .choice("place", &StrainGaugeInput::place, {{"root", Place::root}, {"outside", Place::outside}},
              "root: in the root of a tooth space; outside: on the free outside of the rim.")
      .required();
  gauge
      .key("angle_deg", &StrainGaugeInput::angle,
           "Angle of the gauge from the middle of tooth 0, as for pins. In a root: any angle within its tooth space.")
      .required()
      .from(-360, 360);
  gauge
      .key("offset_mm", &StrainGaugeInput::offset,
           "Distance from the middle of the tooth space along the surface of the root, counter-clockwise.")
      .fallback(0.0, "in the middle of the tooth space")
      .from(-1e3, 1e3)
      .only_if(is("strain_gauge.place", {"root"}));
  gauge.key("length_mm", &StrainGaugeInput::length, "Length along the surface over which the strain is averaged.")
      .required()
      .above(0, 1e3);
  gauge
      .choice("direction", &StrainGaugeInput::direction, {{"hoop", Direction::hoop}, {"axial", Direction::axial}},
              "hoop: along the surface in the transverse section; axial: along the axis, which needs solid bodies.")
      .fallback("hoop", "as gauges for the load over the face width are placed");
  gauge
      .key("axial_positions_mm", &StrainGaugeInput::axial_positions,
           "Distances from the middle of the common face, positive towards +z; a gauge at each of them. Places beside "
           "the middle need solid bodies; several give K_Hβ as gauges measure it.")
      .absent("one gauge, in the middle of the face")
      .from(-1e5, 1e5)
      .longest(16)
      .not_empty("position")
      .distinct();
  return gauge.done();
}

void check_strain_gauges(Scene& scene, std::vector<Problem>& problems) { GaugeChecks(scene, problems).run(); }

std::vector<fem::StrainGauge> gauges_on(const Scene& scene, const RingInput& ring, double face_width) {
  std::vector<fem::StrainGauge> list;
  for (const auto& gauge : planetary(scene).strain_gauges)
    if (is_on(gauge, ring))
      for (const double position : positions_of(gauge))
        list.push_back({.name = name_at(gauge, position),
                        .place = gauge.place,
                        .direction = gauge.direction,
                        .angle = gauge.angle,
                        .offset = gauge.offset,
                        .length = gauge.length,
                        .z = face_width / 2 + position});
  return list;
}

bool gauges_need_solid(const Scene& scene, const RingInput& ring) {
  return std::any_of(planetary(scene).strain_gauges.begin(), planetary(scene).strain_gauges.end(),
                     [&](const auto& gauge) {
                       const auto& at = gauge.axial_positions;
                       const bool across = at.size() > 1 || (at.size() == 1 && at.front() != 0);
                       return is_on(gauge, ring) && (across || gauge.direction == Direction::axial);
                     });
}

void warn_of_gauges(std::vector<Warning>& list, const Scene& scene) {
  for (const auto& ring : planetary(scene).rings) {
    const bool gauged = std::any_of(planetary(scene).strain_gauges.begin(), planetary(scene).strain_gauges.end(),
                                    [&](const auto& gauge) { return is_on(gauge, ring); });
    if (!gauged || scene.stage.planets < 2 || !ring_structure(ring).opens()) continue;
    list.push_back({"strain_gauges", Severity::warning,
                    "strain gauges show the sum of what each planet's mesh strains by itself. Supports that lift make "
                    "the meshes act on each other, which the sum leaves out",
                    ring.name});
  }
}

std::optional<double> GaugeReadings::face_load_factor(std::size_t gauge) const {
  double sum = 0, largest = 0;
  int count = 0;
  for (const auto& reading : gauges) {
    if (reading.of != gauge) continue;
    sum += reading.range();
    largest = std::max(largest, reading.range());
    ++count;
  }
  if (count < 2) return std::nullopt;
  return largest * count / sum;
}

std::vector<PeriodicCurve> gauge_curves(const Csv& gauges) {
  std::vector<PeriodicCurve> curves;
  for (std::size_t column = 0; column < gauges.columns.size(); ++column) {
    if (!gauges.columns[column].starts_with("gauge_")) continue;
    std::vector<double> values;
    for (const auto& row : gauges.rows) values.push_back(row[column]);
    curves.emplace_back(values, static_cast<int>(values.size()));
  }
  return curves;
}

std::optional<GaugeReadings> gauge_readings(const Scene& scene, const geometry::PlanetarySet& set,
                                            const MeshResult& ring_mesh) {
  const auto& csv = ring_mesh.gauges;
  if (csv.rows.empty()) return std::nullopt;
  const auto angle = csv.column("ring_angle_deg");
  const auto samples = static_cast<int>(csv.rows.size());
  const double first = csv.rows[0][angle] * units::deg;
  Eigen::VectorXd planets(set.planets());
  for (int n = 0; n < set.planets(); ++n) planets[n] = set.planet_angle(n);
  // Relative, of stresses in roots and on the rim: the strain is their multiple.
  const auto error_of = [&](Place place) {
    const auto stress = ring_mesh.largest_stress("ring", place == Place::root ? "root_von_mises" : "rim_von_mises");
    return stress ? stress->error_relative : not_known;
  };
  GaugeReadings readings;
  for (int i = 0; i < samples; ++i) readings.angle.push_back(2 * std::numbers::pi * i / samples);
  const auto curves = gauge_curves(csv);
  std::size_t number = 0;
  for (std::size_t g = 0; g < planetary(scene).strain_gauges.size(); ++g) {
    const auto& input = planetary(scene).strain_gauges[g];
    if (input.ring && *input.ring != ring_mesh.model.variant) continue;
    for (const double position : positions_of(input)) {
      const auto& curve = curves.at(number++);
      GaugeReading reading{name_at(input, position), g, dynamics::strain_over_turn(curve, planets, first, samples)};
      for (double& strain : reading.strain) strain *= micro;
      const auto [low, high] = std::minmax_element(reading.strain.begin(), reading.strain.end());
      reading.smallest = *low;
      reading.largest = *high;
      reading.error = error_of(input.place) * std::max(std::abs(*low), std::abs(*high));
      readings.gauges.push_back(std::move(reading));
    }
  }
  return readings;
}

std::vector<FigureSpec> gauge_figure_specs() {
  return {{.key = "strain_gauge_strain",
           .title = "Largest strain of a gauge",
           .unit = "µm/m",
           .scale = 1 / micro,
           .definition = "largest amount over the gauges on the ring and a revolution of the carrier; absent without "
                         "gauges",
           .better = Better::smaller,
           .effort = FigureEffort::tables},
          {.key = "strain_gauge_face_load_factor",
           .title = "Face load factor by strain gauges",
           .symbol = "K_Hβ",
           .definition = "largest range of the strains of a gauge's axial positions over their mean; absent without "
                         "gauges at several",
           .better = Better::smaller,
           .effort = FigureEffort::tables}};
}

FigureSet figures(const GaugeReadings& readings) {
  FigureSet set;
  Figure largest{0, 0};
  std::optional<double> factor;
  for (const auto& gauge : readings.gauges) {
    const double amount = std::max(std::abs(gauge.smallest), std::abs(gauge.largest));
    if (amount > largest.value) largest = {amount, gauge.error};
    if (const auto of_gauge = readings.face_load_factor(gauge.of)) factor = std::max(factor.value_or(0), *of_gauge);
  }
  set.set("strain_gauge_strain", largest);
  if (factor) set.set("strain_gauge_face_load_factor", *factor);
  return set;
}

Csv to_csv(const GaugeReadings& readings, GaugeFrame frame) {
  Csv csv{.header = {{"frame", frame == GaugeFrame::mirrored
                                   ? "mirror image of the stage, in which the torque of the sun is counter-clockwise"
                                   : "that of the ring, counter-clockwise"}},
          .columns = {"planet_1_angle_deg"},
          .rows = {}};
  for (std::size_t g = 0; g < readings.gauges.size(); ++g) {
    csv.header.emplace_back(fmt::format("gauge_{}", g + 1), readings.gauges[g].gauge);
    csv.columns.push_back(fmt::format("gauge_{}_um_per_m", g + 1));
  }
  for (std::size_t i = 0; i < readings.angle.size(); ++i) {
    auto& row = csv.rows.emplace_back(1, readings.angle[i] / units::deg);
    for (const auto& gauge : readings.gauges) row.push_back(gauge.strain[i] / micro);
  }
  csv.round();
  return csv;
}

Json to_json(const Scene& scene, const GaugeReadings& readings) {
  Json list = Json::array();
  for (const auto& gauge : readings.gauges)
    list.push_back({{"gauge", gauge.gauge},
                    {"largest_strain", json_number(gauge.largest)},
                    {"smallest_strain", json_number(gauge.smallest)},
                    {"error", json_number(gauge.error)}});
  Json factors = Json::object();
  for (std::size_t g = 0; g < planetary(scene).strain_gauges.size(); ++g)
    if (const auto factor = readings.face_load_factor(g))
      factors[planetary(scene).strain_gauges[g].name] = json_number(*factor);
  Json json = {{"gauges", std::move(list)}};
  if (!factors.empty()) json["face_load_factor"] = std::move(factors);
  return json;
}

}  // namespace annulus::app
