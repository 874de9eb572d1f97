#include "dynamics/systems/planetary/mode_kind.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "core/errors.h"

namespace annulus::dynamics {

std::string to_string(ModeKind kind) {
  switch (kind) {
    case ModeKind::rotational:
      return "rotational";
    case ModeKind::translational:
      return "translational";
    case ModeKind::planet:
      return "planet";
    case ModeKind::mixed:
      break;
  }
  return "mixed";
}

KindSorter::KindSorter(const LumpedSystem& system, int planets) : mass_(system.mass()) {
  const int n = system.dofs();
  std::vector<Eigen::RowVectorXd> translation, rotation, unlike;
  // The diagonal of the mass is a fair weight where masses are coupled: only zero or not zero matters.
  const auto row = [&](int i) {
    Eigen::RowVectorXd r = Eigen::RowVectorXd::Zero(n);
    r[i] = std::sqrt(mass_(i, i));
    return r;
  };
  for (const std::string body : {"sun", "ring", "carrier"})
    for (const std::string direction : {"_x", "_y", "_u"})
      if (const int i = system.find(body + direction); i >= 0)
        (direction == "_u" ? rotation : translation).push_back(row(i));
  for (const std::string direction : {"_x", "_y", "_u"}) {
    std::vector<int> index;
    for (int p = 1; p <= planets; ++p)
      if (const int i = system.find("planet" + std::to_string(p) + direction); i >= 0) index.push_back(i);
    for (const int i : index) {
      Eigen::RowVectorXd r = row(i);
      for (const int j : index) r[j] -= std::sqrt(mass_(i, i)) / static_cast<double>(index.size());
      unlike.push_back(r);
    }
  }
  const auto stacked = [n](const std::vector<Eigen::RowVectorXd>& rows) {
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), n);
    for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = rows[i];
    return matrix;
  };
  central_translation_ = stacked(translation);
  central_rotation_ = stacked(rotation);
  planets_unlike_ = stacked(unlike);
}

ModeKind KindSorter::operator()(const Eigen::VectorXcd& shape) const {
  // (1e-6)^2 is far above the solver's rounding and far below any participation that means something.
  constexpr double nothing = 1e-12;
  const bool translates = (central_translation_ * shape).squaredNorm() >= nothing;
  const bool turns = (central_rotation_ * shape).squaredNorm() >= nothing;
  if (!translates && (planets_unlike_ * shape).squaredNorm() < nothing) return ModeKind::rotational;
  if (turns) return ModeKind::mixed;
  return translates ? ModeKind::translational : ModeKind::planet;
}

template <class Matrix>
Matrix KindSorter::separate(const Matrix& shapes) const {
  // The form |unlike|^2 + 2 |translation|^2 is 0 for rotational, 1 for planet and above 1 for translational shapes.
  const Matrix unlike = planets_unlike_ * shapes, translation = central_translation_ * shapes;
  const Matrix form = unlike.adjoint() * unlike + 2 * translation.adjoint() * translation;
  const Matrix gram = shapes.adjoint() * mass_ * shapes;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(form, gram);
  if (solver.info() != Eigen::Success)
    throw SolverError(fmt::format("{} shapes of a multiple natural frequency are not independent", shapes.cols()));
  return shapes * solver.eigenvectors();
}

Eigen::MatrixXd KindSorter::separated(const Eigen::MatrixXd& shapes) const { return separate(shapes); }
Eigen::MatrixXcd KindSorter::separated(const Eigen::MatrixXcd& shapes) const { return separate(shapes); }

}  // namespace annulus::dynamics
