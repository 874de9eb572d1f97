#include "app/systems/shared/bearing_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

namespace annulus::app {

namespace {

using dynamics::StageBearing;

/// What the bearings of a body do in one direction.
struct Hold {
  std::vector<std::string> stiff{}, elastic{};

  [[nodiscard]] DofPlan plan(const std::string& dof) const {
    if (!stiff.empty()) return {dof, false, fmt::format("rigid bearing {}: dropped", fmt::join(stiff, ", "))};
    if (elastic.empty()) return {dof, true, "no bearing holds it: the teeth do"};
    return {dof, true, fmt::format("bearing {}", fmt::join(elastic, ", "))};
  }
};

/// `stiffness`: N/m or N m/rad in this direction, of a bearing; infinite, or 0 for none.
Hold hold(const std::vector<StageBearing>& bearings, const std::function<double(const StageBearing&)>& stiffness) {
  Hold result;
  for (const auto& b : bearings) {
    const double k = stiffness(b);
    if (k > 0) (k == rigid ? result.stiff : result.elastic).push_back("'" + b.name + "'");
  }
  return result;
}

constexpr double some = 1;  ///< a stiffness that follows from contacts or a table

double radial(const StageBearing& b) { return b.matrix || b.row || !b.distance.empty() ? some : std::max(b.x, b.y); }
double axial(const StageBearing& b) {
  const bool of_row = b.row && (b.row->contact_angle != 0 || b.row->element == dynamics::RollingRow::Element::ball);
  return b.matrix || of_row ? some : b.axial;
}

}  // namespace

DofPlan radial_dof(const std::string& name, const std::vector<StageBearing>& bearings) {
  return hold(bearings, radial).plan(name + " x, y");
}

DofPlan axial_dof(const std::string& name, const std::vector<StageBearing>& bearings) {
  return hold(bearings, axial).plan(name + " z");
}

DofPlan tilt_dof(const std::string& name, const std::vector<StageBearing>& bearings) {
  const auto stiff = std::count_if(bearings.begin(), bearings.end(), [](const auto& b) { return radial(b) == rigid; });
  const auto places = std::count_if(bearings.begin(), bearings.end(), [](const auto& b) { return radial(b) > 0; });
  return hold(bearings,
              [&](const StageBearing& b) {
                if (b.tilt == rigid || (stiff > 1 && radial(b) == rigid)) return rigid;
                return std::max(b.tilt, b.matrix || b.row || places > 1 ? radial(b) : 0.0);
              })
      .plan(name + " tilts");
}

DofPlan no_dof_out_of_plane(const std::string& name) {
  return {name + " z, tilts", false, "nothing moves it out of the plane: dropped"};
}

Warning tilt_inertia_assumed(const std::vector<std::string>& keys) {
  return {"tilt_inertia_assumed", Severity::warning,
          fmt::format("tilt inertias are those of uniform cylinders as wide as the face, because the scene does not "
                      "mention {}. Natural frequencies of tilting modes depend on it",
                      fmt::join(keys, ", "))};
}

}  // namespace annulus::app
