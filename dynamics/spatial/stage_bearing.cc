#include "dynamics/spatial/stage_bearing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/spatial/elastic_laws.h"

namespace annulus::dynamics {

using Eigen::Vector3d;

bool StageLoad::stands_in_housing() const {
  return frame == StageFrame::housing && (force.head<2>().any() || moment.head<2>().any() || point.head<2>().any());
}

namespace {

std::optional<RollingRow> mirrored(std::optional<RollingRow> row) {
  if (row) row->contact_angle = -row->contact_angle;
  return row;
}

/// A bearing and its mirror image about the middle of the face do the same.
bool mirrors(const StageBearing& a, const StageBearing& b) {
  return a.body == b.body && a.on == b.on && a.frame == b.frame && a.place == -b.place && a.x == b.x && a.y == b.y &&
         a.play == b.play && a.load_zone == b.load_zone && a.row == mirrored(b.row) && a.distance == b.distance &&
         a.force == b.force && !a.matrix && !b.matrix;
}

/// Do two measures agree but for motions out of the plane?
bool same_in_plane(const Mechanism::Measure& a, const Mechanism::Measure& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if ((i % 6 < 2 || i % 6 == 5) && a[i] != b[i]) return false;
  return true;
}

}  // namespace

bool keeps_plane(const Eigen::MatrixXd& k) {
  constexpr double rounding = 1e-12;
  for (Eigen::Index in = 0; in < k.rows(); ++in)
    for (Eigen::Index out = 0; out < k.cols(); ++out)
      if (in % 5 < 2 && out % 5 >= 2 && std::abs(k(in, out)) > rounding * std::sqrt(k(in, in) * k(out, out)))
        return false;
  return true;
}

void add_reasons(std::vector<std::string>& reasons, const std::vector<StageLoad>& loads,
                 const std::vector<StageWeight>& weights, const Vector3d& gravity) {
  for (const auto& load : loads) {
    const bool transverse = load.force.head<2>().any();
    if (load.force.z() != 0 || load.moment.head<2>().any() || (transverse && load.point.z() != 0))
      reasons.push_back(
          fmt::format("load '{}' acts along the axis or tilts the {}", load.name, name_of_body(load.body)));
  }
  if (gravity.z() != 0 && !weights.empty()) reasons.emplace_back("gravity acts along the axis");
  if (gravity.head<2>().any())
    for (const auto& weight : weights)
      if (weight.place != 0)
        reasons.push_back(
            fmt::format("the weight of the {} acts beside the middle of the face", name_of_body(weight.body)));
}

void add_reasons(std::vector<std::string>& reasons, const std::vector<StageBearing>& bearings) {
  for (const auto& b : bearings) {
    const bool paired =
        b.matrix ? b.place == 0 && keeps_plane(*b.matrix)
                 : std::any_of(bearings.begin(), bearings.end(), [&](const auto& o) { return mirrors(b, o); });
    const bool radial = b.holds_radially();
    if (radial && !paired)
      reasons.push_back(fmt::format("bearing '{}' of the {} has no counterpart on the other side of the face", b.name,
                                    name_of_body(b.body)));
  }
}

Mechanism::Measure BearingAssembly::measure(const StageBearing& b, const BearingPlace& place, int coordinate) const {
  const Vector3d point = place.middle + b.place * Vector3d::UnitZ();
  return coordinate < 3 ? mechanism_.displacement(place.body, place.on, point, place.axes.col(coordinate))
                        : mechanism_.rotation(place.body, place.on, place.axes.col(coordinate - 3));
}

/// Element on some coordinates of a bearing.
void BearingAssembly::add_element(MadeBearing& made, const StageBearing& b, const BearingPlace& place,
                                  const std::vector<int>& coordinates, std::shared_ptr<const ElasticLaw> law) {
  const auto count = static_cast<Eigen::Index>(coordinates.size());
  Eigen::MatrixXd measures(count, 6 * static_cast<Eigen::Index>(mechanism_.bodies()));
  for (Eigen::Index i = 0; i < count; ++i)
    measures.row(i) = measure(b, place, coordinates[static_cast<std::size_t>(i)]);
  const int element = mechanism_.add_element(b.name, measures, std::move(law), Eigen::VectorXd::Zero(count));
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    made.element.at(static_cast<std::size_t>(coordinates[i])) = element;
    made.coordinate.at(static_cast<std::size_t>(coordinates[i])) = static_cast<int>(i);
  }
}

void BearingAssembly::hold(MadeBearing& made, const StageBearing& b, const BearingPlace& place, int coordinate) {
  constexpr const char* words[] = {"the x position", "the y position", "the axial position", "the tilt about x",
                                   "the tilt about y"};
  const auto row = measure(b, place, coordinate);
  int& held = made.held.at(static_cast<std::size_t>(coordinate));
  // In the plane two bearings on either side of the face hold the same, and share it.
  if (!space_)
    for (std::size_t h = 0; h < holds_.size(); ++h)
      if (same_in_plane(holds_[h], row)) {
        held = static_cast<int>(h);
        ++shared_[h];
        return;
      }
  holds_.push_back(row);
  shared_.push_back(1);
  held =
      mechanism_.hold(fmt::format("{} of the {} (bearing '{}')", words[coordinate], name_of_body(b.body), b.name), row);
}

void BearingAssembly::add_scalar(MadeBearing& made, const StageBearing& b, const BearingPlace& place, int coordinate,
                                 double stiffness, double play) {
  if (stiffness == 0) return;
  if (stiffness == rigid) return hold(made, b, place, coordinate);
  if (play > 0)
    add_element(made, b, place, {coordinate}, std::make_shared<StopLaw>(1, stiffness, play));
  else
    add_element(made, b, place, {coordinate}, std::make_shared<LinearLaw>(Eigen::MatrixXd::Constant(1, 1, stiffness)));
}

MadeBearing BearingAssembly::add(const StageBearing& b, const BearingPlace& place) {
  MadeBearing made{b.name, b.body, b.on, b.frame, b.place, place.axes};
  if (b.matrix) {
    const std::vector<int> coordinates = space_ ? std::vector<int>{0, 1, 2, 3, 4} : std::vector<int>{0, 1};
    const auto count = static_cast<Eigen::Index>(coordinates.size());
    add_element(made, b, place, coordinates, std::make_shared<LinearLaw>(b.matrix->topLeftCorner(count, count)));
    return made;
  }
  if (b.row) {
    made.row = law_of(*b.row, space_);
    add_element(made, b, place, made.row->coordinates(), made.row);
  } else if (!b.distance.empty()) {
    add_element(made, b, place, {0, 1}, std::make_shared<TableLaw>(b.distance, b.force));
  } else if (b.play > 0 && b.x > 0) {
    if (b.load_zone)
      add_element(made, b, place, {0, 1}, std::make_shared<LoadZoneLaw>(RadialBearing(b.x, b.play, b.seat), b.x));
    else
      add_element(made, b, place, {0, 1}, std::make_shared<StopLaw>(2, b.x, b.play));
  } else {
    add_scalar(made, b, place, 0, b.x, 0);
    add_scalar(made, b, place, 1, b.y, 0);
  }
  if (!space_) return made;
  if (made.element[2] < 0) add_scalar(made, b, place, 2, b.axial, b.axial_play);
  if (b.row) return made;
  if (b.tilt_play > 0 && b.tilt > 0) {
    add_element(made, b, place, {3, 4}, std::make_shared<StopLaw>(2, b.tilt, b.tilt_play));
  } else {
    add_scalar(made, b, place, 3, b.tilt, 0);
    add_scalar(made, b, place, 4, b.tilt, 0);
  }
  return made;
}

}  // namespace annulus::dynamics
