#include "dynamics/spatial/bearing_assembly.h"

#include <fmt/format.h>

#include <utility>

namespace annulus::dynamics {

using Eigen::Vector3d;

namespace {

/// Do two measures agree but for motions out of the plane?
bool same_in_plane(const Mechanism::Measure& a, const Mechanism::Measure& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i)
    if ((i % 6 < 2 || i % 6 == 5) && a[i] != b[i]) return false;
  return true;
}

}  // namespace

Mechanism::Measure BearingAssembly::measure(const StageBearing& b, const BearingPlace& place, int coordinate) const {
  const Vector3d point = place.middle + place.axes.leftCols<2>() * b.beside + b.place * Vector3d::UnitZ();
  return coordinate < 3 ? mechanism_.displacement(place.body, place.on, point, place.axes.col(coordinate))
                        : mechanism_.rotation(place.body, place.on, place.axes.col(coordinate - 3));
}

void BearingAssembly::add_part(MadeBearing& made, const StageBearing& b, const BearingPlace& place,
                               const BearingPart& part) {
  const Eigen::Index count = std::ssize(part.coordinates);
  Eigen::MatrixXd measures(count, 6 * static_cast<Eigen::Index>(mechanism_.bodies()));
  for (Eigen::Index i = 0; i < count; ++i)
    measures.row(i) = measure(b, place, part.coordinates[static_cast<std::size_t>(i)]);
  const int element = mechanism_.add_element(b.name, measures, part.law, Eigen::VectorXd::Zero(count));
  for (std::size_t i = 0; i < part.coordinates.size(); ++i) {
    made.element.at(static_cast<std::size_t>(part.coordinates[i])) = element;
    made.coordinate.at(static_cast<std::size_t>(part.coordinates[i])) = static_cast<int>(i);
  }
  if (part.row) made.rolling = part.row;
}

void BearingAssembly::hold(MadeBearing& made, const StageBearing& b, const BearingPlace& place, int coordinate) {
  constexpr const char* words[] = {"the x position", "the y position", "the axial position", "the tilt about x",
                                   "the tilt about y"};
  const auto row = measure(b, place, coordinate);
  int& held = made.held.at(static_cast<std::size_t>(coordinate));
  // In the plane two bearings on either side of the face hold the same, and share it.
  if (motions_ == Motions::in_plane)
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

MadeBearing BearingAssembly::add(const StageBearing& b, const BearingPlace& place) {
  MadeBearing made{b, place.axes};
  for (const auto& part : parts_of(b, motions_)) add_part(made, b, place, part);
  if (b.matrix) return made;
  const std::array stiffness{b.x, b.y, b.axial, b.tilt, b.tilt};
  for (int i = 0; i < (motions_ == Motions::in_space ? 5 : 2); ++i)
    if (stiffness.at(static_cast<std::size_t>(i)) == rigid && made.element.at(static_cast<std::size_t>(i)) < 0 &&
        !(b.row && i > 2))
      hold(made, b, place, i);
  return made;
}

}  // namespace annulus::dynamics
