#pragma once

namespace annulus::fem {

/// Isotropic linear elasticity; plane problems are plane strain.
struct Material {
  double youngs_modulus = 206e9;  ///< Pa
  double poisson_ratio = 0.3;
  double density = 7850;  ///< kg/m^3
};

/// What the pinion and the wheel of a mesh are made of.
struct MeshMaterials {
  Material pinion{}, wheel{};

  MeshMaterials() = default;
  /// One material for both.
  MeshMaterials(const Material& both) : pinion(both), wheel(both) {}
  MeshMaterials(const Material& of_pinion, const Material& of_wheel) : pinion(of_pinion), wheel(of_wheel) {}

  /// E* of a contact, Pa: 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 [Johnson1985].
  [[nodiscard]] double contact_modulus() const { return 1 / (yielding(pinion) + yielding(wheel)); }
  /// Pa, of two springs in series: 2 E_1 E_2 / (E_1 + E_2), as [ISO6336-1] has it for the stiffness of a pair.
  [[nodiscard]] double youngs_modulus() const {
    return 2 * pinion.youngs_modulus * wheel.youngs_modulus / (pinion.youngs_modulus + wheel.youngs_modulus);
  }
  [[nodiscard]] double larger_poisson_ratio() const {
    return pinion.poisson_ratio > wheel.poisson_ratio ? pinion.poisson_ratio : wheel.poisson_ratio;
  }

 private:
  static double yielding(const Material& m) { return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus; }
};

}  // namespace annulus::fem
