#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "app/run/solved_case.h"
#include "app/scene/overrides.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "dynamics/modes/linear_system.h"

namespace py = pybind11;

namespace annulus {

namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

/// A lumped system with the memory of its evaluations: one thread at a time.
class Lumped {
 public:
  explicit Lumped(dynamics::LumpedCase found) : case_(std::move(found)), workspace_(case_.system.workspace()) {}

  [[nodiscard]] const dynamics::LumpedSystem& system() const { return case_.system; }
  [[nodiscard]] const dynamics::SteadyProblem& problem() const { return case_.problem; }

  [[nodiscard]] VectorXd rhs(double t, const VectorXd& y) {
    set_contact(t, y);
    VectorXd rate(y.size());
    system().rhs(t, y.data(), rate.data(), workspace_);
    return rate;
  }
  [[nodiscard]] MatrixXd jacobian(double t, const VectorXd& y) {
    set_contact(t, y);
    MatrixXd result(y.size(), y.size());
    system().jacobian(t, y.data(), result, workspace_);
    return result;
  }
  /// N, one per mesh.
  [[nodiscard]] VectorXd mesh_forces(double t, const VectorXd& y) {
    set_contact(t, y);
    system().evaluate_meshes(t, y.data(), y.data() + system().dofs(), workspace_);
    return Eigen::Map<const VectorXd>(workspace_.force.data(), static_cast<Eigen::Index>(workspace_.force.size()));
  }

 private:
  void set_contact(double t, const VectorXd& y) {
    if (y.size() != 2 * system().dofs())
      throw InputError("a state has " + std::to_string(2 * system().dofs()) + " entries (q, v), not " +
                       std::to_string(y.size()));
    system().detect_contact(t, y.data(), workspace_);
  }

  dynamics::LumpedCase case_;
  dynamics::LumpedSystem::Workspace workspace_;
};

Lumped solve(const std::string& file, const std::vector<std::string>& settings, const std::string& variant,
             int threads) {
  log::set_level(log::Level::quiet);
  return Lumped(app::solved_case(app::read_scene_with(file, settings), variant, threads));
}

}  // namespace

PYBIND11_MODULE(_lumped, module) {
  // Translators that are registered last are asked first.
  const auto exceptions = py::module_::import("annulus._program");
  py::register_exception<Error>(module, "Error", exceptions.attr("Refused"));
  py::register_exception<FileError>(module, "FileError", exceptions.attr("InputError"));
  py::register_exception<InputError>(module, "InputError", exceptions.attr("InputError"));
  using dynamics::LinearSystem;
  py::class_<LinearSystem>(module, "LinearSystem")
      .def_readonly("dofs", &LinearSystem::dofs)
      .def_readonly("meshes", &LinearSystem::meshes)
      .def_readonly("mass", &LinearSystem::mass)
      .def_readonly("damping", &LinearSystem::damping)
      .def_readonly("gyroscopic", &LinearSystem::gyroscopic)
      .def_readonly("stiffness", &LinearSystem::stiffness)
      .def_readonly("rotating_stiffness", &LinearSystem::rotating_stiffness)
      .def_readonly("mesh_vectors", &LinearSystem::mesh_vectors)
      .def_readonly("mesh_stiffness", &LinearSystem::mesh_stiffness)
      .def_readonly("mesh_damping", &LinearSystem::mesh_damping)
      .def_readonly("load", &LinearSystem::load);
  py::class_<Lumped>(module, "Lumped")
      .def("linear", [](const Lumped& l) { return dynamics::linear_system(l.system()); })
      .def_property_readonly("mesh_frequency_Hz", [](const Lumped& l) { return l.problem().mesh_frequency; })
      .def_property_readonly("period_in_cycles", [](const Lumped& l) { return l.problem().period_in_cycles; })
      .def("rhs", &Lumped::rhs)
      .def("jacobian", &Lumped::jacobian)
      .def("mesh_forces", &Lumped::mesh_forces);
  module.def("solve", &solve, py::call_guard<py::gil_scoped_release>());
}

}  // namespace annulus
