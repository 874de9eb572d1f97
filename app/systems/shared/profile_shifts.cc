#include "app/systems/shared/profile_shifts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/plan/gear_geometry.h"
#include "app/scene/gear_tables.h"
#include "core/errors.h"
#include "core/units.h"
#include "geometry/measurements.h"

namespace annulus::app {

namespace {

class ShiftResolver : KeyChecks {
 public:
  ShiftResolver(Scene& scene, std::vector<Problem>& problems, const std::vector<ShiftedGear>& gears)
      : KeyChecks(scene, problems), gears_(gears), known_(gears.size()) {}

  void run() {
    for (std::size_t i = 0; i < gears_.size(); ++i) {
      const auto from = gears_[i].gear->shift_from;
      if (from == ShiftSource::given)
        known_[i] = usable(key(i, "profile_shift"), entry(i));
      else if (from != ShiftSource::centre_distance)
        resolve(i, [&] { return measured(i); });
    }
    for (std::size_t i = 0; i < gears_.size(); ++i)
      if (gears_[i].gear->shift_from == ShiftSource::centre_distance) from_mate(i);
    for (std::size_t i = 0; i < gears_.size(); ++i)
      if (gears_[i].kind == geometry::GearKind::internal && known_[i]) give_tip(i);
    if (scene_.stage.tip_shortening != TipShortening::full) return;
    for (std::size_t i = 0; i < gears_.size(); ++i)
      if (gears_[i].kind == geometry::GearKind::external && known_[i] && mate_known(i)) shorten_tip(i);
  }

 private:
  [[nodiscard]] std::string key(std::size_t i, const char* name) const { return gears_[i].table + "." + name; }
  [[nodiscard]] Entry entry(std::size_t i) const {
    return gears_[i].ring.empty() ? Entry(std::size_t{0}) : Entry(gears_[i].ring);
  }
  [[nodiscard]] geometry::GearParameters parameters(std::size_t i) const {
    return gear_parameters(scene_, *gears_[i].gear, gears_[i].kind);
  }
  [[nodiscard]] bool mate_known(std::size_t i) const {
    const auto found =
        std::find_if(gears_.begin(), gears_.end(), [&](const auto& g) { return g.gear == gears_[i].mate; });
    return found != gears_.end() && known_[static_cast<std::size_t>(found - gears_.begin())];
  }

  struct Shift {
    double x = 0;
    std::string how{};
  };

  template <class Find>
  void resolve(std::size_t i, const Find& find) {
    const auto refuse = [&](const std::string& why) { problem(key(i, "profile_shift_from"), entry(i), why); };
    try {
      const Shift shift = find();
      if (!(shift.x >= least_shift && shift.x <= largest_shift))
        return refuse(fmt::format("gives a profile shift of {} modules ({}); it must be in range: {} <= x <= {}",
                                  to_text(shift.x, 5), shift.how, to_text(least_shift), to_text(largest_shift)));
      gears_[i].gear->profile_shift = shift.x;
      set(key(i, "profile_shift"), shift.x, Origin::derived, shift.how, entry(i));
      known_[i] = true;
    } catch (const GeometryError& error) {
      refuse(error.what());
    }
  }

  [[nodiscard]] Shift measured(std::size_t i) const {
    const auto p = parameters(i);
    const auto& g = *gears_[i].gear;
    switch (g.shift_from) {
      case ShiftSource::tip_diameter:
        if (!g.tip_diameter) throw GeometryError("needs " + key(i, "tip_diameter_mm"));
        return {geometry::shift_from_tip_diameter(p, *g.tip_diameter), "from the tip diameter, addendum one module"};
      case ShiftSource::root_diameter:
        if (!g.root_diameter) throw GeometryError("needs " + key(i, "root_diameter_mm"));
        return {geometry::shift_from_root_diameter(p, *g.root_diameter),
                "from the root diameter, dedendum 1.25 modules"};
      case ShiftSource::span:
        return {geometry::shift_from_span(p, g.span_teeth.value_or(1), g.span.value_or(0)), "from the span"};
      case ShiftSource::pins:
        return {geometry::shift_from_pins(p, g.measuring_pin.value_or(0), g.over_pins.value_or(0)),
                "from the dimension over pins"};
      case ShiftSource::given:
      case ShiftSource::centre_distance:
        break;
    }
    throw InternalError("internal error: a profile shift that is not measured");
  }

  void from_mate(std::size_t i) {
    const auto& g = gears_[i];
    if (!usable("stage.centre_distance_mm") || !(scene_.stage.centre_distance > 0)) {
      if (!given("stage.centre_distance_mm"))
        problem(key(i, "profile_shift_from"), entry(i), "needs stage.centre_distance_mm");
      return;
    }
    if (!mate_known(i)) {
      if (g.mate->shift_from == ShiftSource::centre_distance)
        problem(key(i, "profile_shift_from"), entry(i),
                fmt::format("needs the profile shift of the {}, which follows from the centre distance too: give one "
                            "of them",
                            g.mate_table));
      return;
    }
    resolve(i, [&] {
      const bool internal = g.kind == geometry::GearKind::internal;
      const double both = geometry::shifts_from_centre_distance(
          gear_parameters(scene_, *g.mate, geometry::GearKind::external), parameters(i), scene_.stage.centre_distance,
          g.gear->normal_backlash.value_or(0));
      const double mate = g.mate->profile_shift;
      return Shift{
          internal ? both + mate : both - mate,
          fmt::format("from the centre distance and the profile shift {} of the {}", to_text(mate, 6), g.mate_table)};
    });
  }

  /// A ring's tip circle of one module of addendum often reaches below the start of the planets' involutes.
  void give_tip(std::size_t i) {
    const auto& g = gears_[i];
    if (given(key(i, "tip_diameter_mm"), entry(i)) || !mate_known(i) || !(scene_.stage.centre_distance > 0)) return;
    try {
      const geometry::Gear mate(gear_parameters(scene_, *g.mate, geometry::GearKind::external));
      const auto p = parameters(i);
      const double reference = p.module * p.teeth / (2 * std::cos(p.helix_angle));
      const double base = reference * mate.base_radius() / mate.reference_radius();
      const double a = scene_.stage.centre_distance, difference = base - mate.base_radius();
      if (!(a > std::abs(difference))) return;  // refused with its reason where the gears are paired
      const double form = std::sqrt(mate.form_radius() * mate.form_radius() - mate.base_radius() * mate.base_radius());
      const double least = std::hypot(base, std::sqrt(a * a - difference * difference) + form);
      const double usual = reference - p.module * (1 - p.profile_shift);
      if (usual >= least) return;
      const double micrometres = std::ceil(2 * least / units::um);
      g.gear->tip_diameter = micrometres * units::um;
      set(key(i, "tip_diameter_mm"), micrometres * units::um / units::mm, Origin::derived,
          fmt::format("addendum shortened from one module to {} modules, so that the tip meets the involute of the {}",
                      to_text((reference - least) / p.module + p.profile_shift, 3), g.mate_table),
          entry(i));
    } catch (const GeometryError&) {  // reported with its reason where the gears are made
    }
  }

  /// k = x_1 + x_2 - (a - a_d) / m_n [ISO21771], where it is above zero.
  void shorten_tip(std::size_t i) {
    const auto& g = gears_[i];
    if (given(key(i, "tip_diameter_mm"), entry(i)) || !(scene_.stage.centre_distance > 0)) return;
    const auto p = parameters(i);
    const double transverse = p.module / std::cos(p.helix_angle);
    const double unshifted = transverse * (p.teeth + g.mate->teeth) / 2;
    const double k = p.profile_shift + g.mate->profile_shift - (scene_.stage.centre_distance - unshifted) / p.module;
    if (!(k > 0)) return;
    g.gear->tip_diameter = transverse * p.teeth + 2 * p.module * (1 + p.profile_shift - k);
    set(key(i, "tip_diameter_mm"), *g.gear->tip_diameter / units::mm, Origin::derived,
        fmt::format("addendum of one module, shortened by k = {} modules", to_text(k, 4)), entry(i));
  }

  const std::vector<ShiftedGear>& gears_;
  std::vector<bool> known_;
};

}  // namespace

void resolve_profile_shifts(Scene& scene, std::vector<Problem>& problems, const std::vector<ShiftedGear>& gears) {
  ShiftResolver(scene, problems, gears).run();
}

}  // namespace annulus::app
