#include "app/model/study_result.h"

#include <algorithm>

namespace annulus::app {

const FigureStatistics* VariantSamples::find(const std::string& figure) const {
  const auto found =
      std::find_if(statistics.begin(), statistics.end(), [&](const auto& s) { return s.figure == figure; });
  return found == statistics.end() ? nullptr : &*found;
}

const FigureSpec* StudyResults::ordering() const {
  const auto found = std::find_if(figures.begin(), figures.end(), [](const auto& f) { return f.ordering; });
  return found == figures.end() ? nullptr : &*found;
}

}  // namespace annulus::app
