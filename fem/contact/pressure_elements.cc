#include "fem/contact/pressure_elements.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "fem/contact/hertz.h"

namespace annulus::fem {

double PressureElements::shortest(const ToothPair& pair, double arc) const {
  const auto& flanks = bodies_.face.flanks();
  const double pinion = bodies_.pinion.shortest_element(pair.index, arc);
  if (pinion == 0) return 0;
  const double roll = std::sqrt(2 * flanks.pair().pinion().base_radius() * std::max(arc, 0.0));
  const double opposite = flanks.match(roll, pair.roll).wheel_roll;
  const double wheel_arc = opposite * opposite / (2 * flanks.pair().wheel().base_radius());
  return std::max(pinion, bodies_.wheel.shortest_element(wheel_tooth(flanks, pair.index, 0), wheel_arc));
}

std::vector<double> PressureElements::edges(const ToothPair& pair, double centre, double direction, double half,
                                            int per_side) const {
  std::vector<double> edges = {0};
  if (shortest(pair, centre) == 0) {
    // Shortest at the centre, where pairs that carry little have all their contact.
    for (int i = 1; i <= per_side; ++i) {
      const double t = static_cast<double>(i) / per_side;
      edges.push_back(half * t * (options_.first + (1 - options_.first) * t));
    }
    return edges;
  }
  // Elements shorter than cells would make the compliance singular: a window that a tip edge cuts short has fewer of
  // them, and beyond the finely meshed part they grow with the cells.
  while (edges.back() < half) {
    const double first_guess = shortest(pair, centre + direction * edges.back());
    const double middle = std::min(half, edges.back() + first_guess / 2);
    edges.push_back(edges.back() + shortest(pair, centre + direction * middle));
  }
  // The last one ends at the end: by stretching or by squeezing all a little.
  if (edges.size() > 2 && edges.back() - half > half - edges[edges.size() - 2]) edges.pop_back();
  const double stretch = half / edges.back();
  for (double& edge : edges) edge *= stretch;
  return edges;
}

void PressureElements::add(ToothPair& pair, const FacingFlanks& facing, double load, double window) const {
  const auto& flanks = bodies_.face.flanks();
  const auto& z = bodies_.face.slice_edges();
  const auto& domain = facing.domain;
  const double roll = facing.roll, centre_roll = facing.centre_roll;
  const auto* measured = bodies_.face.measured(facing.slices.front());
  const double base = flanks.pair().pinion().base_radius(), wheel_base = flanks.pair().wheel().base_radius();
  const double half_width = hertz_half_width(flanks, roll, load / bodies_.face.width(), materials_);
  const auto arc_of = [&](double pinion_roll) { return pinion_roll * pinion_roll / (2 * base); };
  const auto roll_of = [&](double arc) {
    return std::clamp(std::sqrt(2 * base * std::max(arc, 0.0)), domain.low, domain.high);
  };
  const double centre = arc_of(centre_roll), half = window * half_width;
  // As many elements in a window that a tip edge cuts short as in a whole one: as the teeth move on, the elements
  // change their lengths continuously, and so does the result.
  const int per_side = static_cast<int>(std::ceil(options_.elements * std::max(1.0, window / options_.window)));
  const double low_room = centre - arc_of(domain.low), high_room = arc_of(domain.high) - centre;
  // Of a half-width, and of an element: no place for elements.
  const double negligible = std::max(0.02 * half_width, 0.5 * shortest(pair, centre));
  const double low_half = low_room < negligible ? 0 : std::min(half, low_room);
  const double high_half = high_room < negligible ? 0 : std::min(half, high_room);
  if (low_half == 0 && high_half == 0) return;  // two tips that barely reach each other
  std::vector<double> edges;
  if (low_half > 0) {
    const auto down = this->edges(pair, centre, -1, low_half, per_side);
    for (auto edge = down.rbegin(); edge + 1 != down.rend(); ++edge) edges.push_back(centre - *edge);
  }
  edges.push_back(low_half > 0 ? (high_half > 0 ? centre : arc_of(domain.high)) : arc_of(domain.low));
  if (high_half > 0) {
    const auto up = this->edges(pair, centre, 1, high_half, per_side);
    for (auto edge = up.begin() + 1; edge != up.end(); ++edge) edges.push_back(centre + *edge);
  }

  const int first_load = static_cast<int>(pair.pinion.loads.size());
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    const double low = edges[e], high = edges[e + 1];
    ToothPair::Element element;
    element.roll_low = roll_of(low);
    element.roll_high = roll_of(high);
    element.distance = (low + high) / 2 - centre;
    const bool first = e == 0, last = e + 2 == edges.size();
    const bool low_cut = low_half < half, high_cut = high_half < half;
    element.tip_edge = (first && low_cut) || (last && high_cut);
    element.outermost = (first && !low_cut) || (last && !high_cut);
    double gap = 0, wheel_arc = 0, wheel_low = 0, wheel_high = 0;
    using Rule = boost::math::quadrature::gauss<double, 2>;  // of a parabola the very mean
    for (std::size_t q = 0; q < Rule::abscissa().size(); ++q)
      for (const double side : {-1.0, 1.0}) {
        const double weight = Rule::weights()[q] / 2;
        const auto match =
            flanks.match(roll_of((low + high) / 2 + side * Rule::abscissa()[q] * (high - low) / 2), roll, measured);
        gap += weight * match.gap;
        const double arc = match.wheel_roll * match.wheel_roll / (2 * wheel_base);
        wheel_arc += weight * arc;
        if (q + 1 == Rule::abscissa().size()) (side < 0 ? wheel_low : wheel_high) = arc;
      }
    pair.pinion.loads.push_back(bodies_.pinion.make_load(pair.index, (low + high) / 2, (high - low) / 2));
    pair.wheel.loads.push_back(bodies_.wheel.make_load(wheel_tooth(flanks, pair.index, 0), wheel_arc,
                                                       std::abs(wheel_high - wheel_low) / 2 / Rule::abscissa().back()));
    for (const int s : facing.slices) {
      element.gap = bodies_.face.normal_factor() * gap + bodies_.face.lead_gap(s);
      element.area = (high - low) * (z[s + 1] - z[s]) / bodies_.face.normal_factor();
      pair.elements.push_back(element);
      const FlankPatch::Element of_patch{first_load + static_cast<int>(e), s};
      pair.pinion.elements.push_back(of_patch);
      pair.wheel.elements.push_back(of_patch);
    }
  }
  for (const int s : facing.slices)
    pair.smallest_gap = std::min(pair.smallest_gap, gap_without_load(bodies_.face, facing, s));
}

double gap_without_load(const ContactFace& face, const FacingFlanks& facing, int slice) {
  return (facing.gap + face.smallest_lead_gap(slice)) / face.normal_factor();
}

}  // namespace annulus::fem
