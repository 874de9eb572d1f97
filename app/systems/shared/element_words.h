#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace annulus::app {

/// Groups of elements for readers: "crank bearings" for crank_bearing.
[[nodiscard]] std::string element_group(const std::string& name);
/// "sun meshes 61 %, crank bearings 30 %": the groups with most strain energy, at most so many and from 5 % on.
[[nodiscard]] std::string strain_words(const std::vector<std::string>& groups,
                                       const Eigen::Ref<const Eigen::VectorXd>& shares, std::size_t most);

}  // namespace annulus::app
