#include "dynamics/spatial/linearised.h"

namespace annulus::dynamics {

Linearised linearised(const MadeBearing& bearing, const Mechanism::Equilibrium& at) {
  Linearised found;
  LinearBearing& result = found.bearing;
  result.name = bearing.name;
  // A bearing of every planet has the planet in its name as well.
  if (const auto own = " " + name_of_body(bearing.body); result.name.ends_with(own))
    result.name.resize(result.name.size() - own.size());
  result.body = bearing.body;
  result.on = bearing.on;
  result.place = bearing.place;
  for (std::size_t i = 0; i < 5; ++i) {
    result.rigid.at(i) = bearing.held.at(i) >= 0;
    const int element = bearing.element.at(i);
    if (element < 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    const auto& state = at.state[static_cast<std::size_t>(element)];
    found.deflection[row] = at.deflection[static_cast<std::size_t>(element)][bearing.coordinate.at(i)];
    result.preload[row] = state.force[bearing.coordinate.at(i)];
    for (std::size_t j = 0; j < 5; ++j) {
      if (bearing.element.at(j) != element) continue;
      const double tangent = state.tangent(bearing.coordinate.at(i), bearing.coordinate.at(j));
      result.stiffness(row, static_cast<Eigen::Index>(j)) = tangent;
      result.preload[row] -= tangent * at.deflection[static_cast<std::size_t>(element)][bearing.coordinate.at(j)];
    }
  }
  return found;
}

void flatten(LinearBearing& bearing) {
  for (const Eigen::Index k : {2, 3, 4}) {
    bearing.stiffness.row(k).setZero();
    bearing.stiffness.col(k).setZero();
    bearing.preload[k] = bearing.standing[k] = 0;
    bearing.rigid.at(static_cast<std::size_t>(k)) = false;
  }
}

LinearBearing plane_guide(const StageBody& body) {
  LinearBearing guide;
  guide.name = "plane";
  guide.body = body;
  if (body.kind == StageBody::Kind::planet) guide.on = {StageBody::Kind::carrier};
  guide.rigid = {false, false, true, true, true};
  return guide;
}

}  // namespace annulus::dynamics
