#include "dynamics/system/force_law.h"

#include <cmath>

namespace annulus::dynamics {

namespace {

class RadialLaw final : public ForceLaw {
 public:
  explicit RadialLaw(const RadialBearing& bearing) : bearing_(bearing) {}
  [[nodiscard]] int size() const override { return 2; }

  void evaluate(const double* d, double* force, double* tangent) const override {
    const double distance = std::hypot(d[0], d[1]);
    const auto [size, along] = bearing_(distance);
    const double secant = distance > 0 ? size / distance : along;
    const double a = distance > 0 ? d[0] / distance : 0.0, b = distance > 0 ? d[1] / distance : 0.0;
    force[0] = secant * d[0];
    force[1] = secant * d[1];
    tangent[0] = secant + (along - secant) * a * a;
    tangent[1] = tangent[2] = (along - secant) * a * b;
    tangent[3] = secant + (along - secant) * b * b;
  }
  [[nodiscard]] double energy(const double* d) const override { return bearing_.energy(std::hypot(d[0], d[1])); }

 private:
  RadialBearing bearing_;
};

}  // namespace

std::shared_ptr<const ForceLaw> radial_law(const RadialBearing& bearing) {
  return std::make_shared<RadialLaw>(bearing);
}

}  // namespace annulus::dynamics
