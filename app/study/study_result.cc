#include "app/study/study_result.h"

#include <algorithm>
#include <limits>

#include "app/study/study_subject.h"

namespace annulus::app {

double StudyPoint::value(std::size_t figure) const {
  return figure < values.size() ? values[figure] : std::numeric_limits<double>::quiet_NaN();
}

const FigureStatistics* VariantSamples::find(const std::string& figure) const {
  const auto found =
      std::find_if(statistics.begin(), statistics.end(), [&](const auto& s) { return s.figure == figure; });
  return found == statistics.end() ? nullptr : &*found;
}

double StudyResults::value(const StudyPoint& point, const std::string& column) const {
  return point.value(find_figure(figures, column));
}

const StudyFigure* StudyResults::ordering() const {
  const auto found = std::find_if(figures.begin(), figures.end(), [](const auto& f) { return f.ordering; });
  return found == figures.end() ? nullptr : &*found;
}

}  // namespace annulus::app
