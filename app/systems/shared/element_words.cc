#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "app/systems/shared/element_words.h"

namespace annulus::app {

std::string element_group(const std::string& name) {
  static const std::map<std::string, std::string> words = {{"sun_planet", "sun meshes"},
                                                           {"ring_planet", "ring meshes"},
                                                           {"planet_bearing", "planet bearings"},
                                                           {"ring_body", "the ring between the meshes"},
                                                           {"planet_body", "the planets between their meshes"},
                                                           {"ring_and_planets", "ring and planets between the meshes"},
                                                           {"ring_mode", "elastic modes of the ring"},
                                                           {"arc_pins", "arc meshes"},
                                                           {"crank_arc", "arc gear bearings"},
                                                           {"crank_bearing", "crank bearings"},
                                                           {"planet_shaft", "crank shafts"}};
  if (const auto found = words.find(name); found != words.end()) return found->second;
  std::string text = name;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string strain_words(const std::vector<std::string>& groups, const Eigen::Ref<const Eigen::VectorXd>& shares,
                         std::size_t most) {
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto share = [&](std::size_t group) { return shares[static_cast<Eigen::Index>(group)]; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
  std::vector<std::string> words;
  for (const auto group : order)
    if (words.size() < most && share(group) >= 0.05)
      words.push_back(fmt::format("{} {:.0f} %", element_group(groups[group]), 100 * share(group)));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace annulus::app
