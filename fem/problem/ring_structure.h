#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "fem/problem/ring_body.h"
#include "fem/problem/support_sites.h"

namespace annulus::fem {

/// Outer surface held over the full face width.
struct OutsideHeld {
  [[nodiscard]] RingDescription describe(double outside_radius) const;
};

/// What holds a ring: a value of one of the types in fem/problem/structures/, or of any type with the member function
/// `RingDescription describe(double outside_radius) const` (m; 0 where it is not known) and, when single supports hold
/// it, `SupportSites supports(const SupportedRing&) const`. Nobody else needs to know which type it is. Copies share
/// the immutable value.
class RingStructure {
 public:
  RingStructure() : RingStructure(OutsideHeld{}) {}
  template <class Type, class = std::enable_if_t<!std::is_same_v<std::decay_t<Type>, RingStructure>>>
  RingStructure(Type type) : value_(std::make_shared<const Holder<Type>>(std::move(type))) {}

  /// Elastic body and held surface of a ring of this outside radius, m.
  [[nodiscard]] RingBody body(double outside_radius) const { return value_->describe(outside_radius).body; }
  [[nodiscard]] RingWords words() const { return value_->describe(0).words; }
  [[nodiscard]] std::vector<std::pair<std::string, double>> parameters() const {
    return value_->describe(0).parameters;
  }
  [[nodiscard]] RingDrawing drawing(double outside_radius) const { return value_->describe(outside_radius).drawing; }
  /// Single supports of the outside; none where a surface is held. Angles have the opposite sign of the real ring's:
  /// the frame of the solve is its mirror image. Throws InputError when they cannot hold the ring in equilibrium.
  [[nodiscard]] SupportSites supports(const SupportedRing& ring) const { return value_->supports(ring); }
  /// Whether the ring floats on single supports (pins, bolts, splines).
  [[nodiscard]] bool floating() const { return body(0).held == HeldSurface::none; }
  /// Number of pins, bolts or spline teeth; 0 where a surface is held.
  [[nodiscard]] int single_supports() const { return static_cast<int>(value_->describe(0).support_angles.size()); }
  /// Whether supports touch and part as planets pass: what several planets do is then not the sum of what each does.
  [[nodiscard]] bool opens() const { return value_->describe(0).opens; }
  /// The smallest number of teeth by which a ring of `teeth` teeth can be rotated so that its structure looks the same:
  /// its contact repeats after so many mesh cycles.
  [[nodiscard]] int repeating_teeth(int teeth) const;

  /// The value, when it is a `Type`; null otherwise.
  template <class Type>
  [[nodiscard]] const Type* as() const {
    const auto* holder = dynamic_cast<const Holder<Type>*>(value_.get());
    return holder ? &holder->type : nullptr;
  }

 private:
  struct Interface {
    virtual ~Interface() = default;
    [[nodiscard]] virtual RingDescription describe(double outside_radius) const = 0;
    [[nodiscard]] virtual SupportSites supports(const SupportedRing& ring) const = 0;
  };

  template <class Type, class = void>
  struct OnSingleSupports : std::false_type {};
  template <class Type>
  struct OnSingleSupports<Type, std::void_t<decltype(&Type::supports)>> : std::true_type {};

  template <class Type>
  struct Holder final : Interface {
    explicit Holder(Type value) : type(std::move(value)) {}
    [[nodiscard]] RingDescription describe(double outside_radius) const override {
      return type.describe(outside_radius);
    }
    [[nodiscard]] SupportSites supports([[maybe_unused]] const SupportedRing& ring) const override {
      if constexpr (OnSingleSupports<Type>::value)
        return type.supports(ring);
      else
        return {};
    }
    Type type;
  };

  std::shared_ptr<const Interface> value_;
};

/// Whether the ring floats on single supports (pins, bolts, splines).
[[nodiscard]] inline bool on_single_supports(const RingStructure& structure) { return structure.floating(); }
/// Whether something changes along the face width, which plane models and formulas cannot represent.
[[nodiscard]] inline bool needs_solid(const RingStructure& structure) {
  return !structure.words().solid_reason.empty();
}
/// Whether the outer surface is held all around over the full face width.
[[nodiscard]] inline bool held_outside(const RingStructure& structure) {
  return structure.body(0).held == HeldSurface::outside;
}
/// Whether a rotation by `angle` (rad) maps the angles onto themselves.
[[nodiscard]] bool maps_onto_itself(const std::vector<double>& angles, double angle);

}  // namespace annulus::fem
