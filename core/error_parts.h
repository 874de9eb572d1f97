#pragma once

#include <array>
#include <utility>

namespace annulus {

/// What an estimated error is made of, in the unit of the error. The causes are independent and may add up; NaN: not
/// known.
struct ErrorParts {
  double discretisation = 0;  ///< elements and cells of the bodies
  double contact = 0;         ///< pressure on the flanks
  double condensation = 0;    ///< bodies reduced to what their contacts see
  double interpolation = 0;   ///< between the positions and loads of a stiffness table
  double integration = 0;     ///< of the motion in time: sampling, steady state, integrator
  double model = 0;           ///< what the model leaves out: plane strain, formulas for teeth

  [[nodiscard]] double total() const {
    return discretisation + contact + condensation + interpolation + integration + model;
  }
  ErrorParts& operator+=(const ErrorParts& other);
};
[[nodiscard]] ErrorParts operator*(double factor, const ErrorParts& parts);

/// Names of the parts in files, with their places.
inline constexpr std::array<std::pair<const char*, double ErrorParts::*>, 6> error_part_names = {
    {{"discretisation", &ErrorParts::discretisation},
     {"local_contact", &ErrorParts::contact},
     {"condensation", &ErrorParts::condensation},
     {"table_interpolation", &ErrorParts::interpolation},
     {"time_integration", &ErrorParts::integration},
     {"model_choice", &ErrorParts::model}}};
/// Those of a stiffness.
inline constexpr std::array<std::pair<const char*, double ErrorParts::*>, 4> stiffness_error_part_names = {
    {error_part_names[0], error_part_names[1], error_part_names[2], error_part_names[5]}};

inline ErrorParts& ErrorParts::operator+=(const ErrorParts& other) {
  for (const auto& [name, part] : error_part_names) this->*part += other.*part;
  return *this;
}

inline ErrorParts operator*(double factor, const ErrorParts& parts) {
  ErrorParts result;
  for (const auto& [name, part] : error_part_names) result.*part = factor * (parts.*part);
  return result;
}

}  // namespace annulus
