#include <algorithm>

#include "app/report/svg_plot.h"
#include "page.h"

namespace annulus::manual {

// Lines are references, dots what was computed; without a reference the computed values are the line.
std::string picture_svg(const Picture& picture) {
  app::Plot plot;
  plot.title = picture.title;
  plot.x_label = picture.x_label;
  plot.y_label = picture.y_label;
  plot.x_log = picture.x_log;
  plot.y_log = picture.y_log;
  plot.width = 520;
  plot.height = 300;
  for (std::size_t i = 0; i < picture.curves.size(); ++i) {
    const auto& c = picture.curves[i];
    app::Series line, dots;
    line.colour = dots.colour = i;
    line.x = dots.x = c.x;
    line.dashed = !c.reference.empty() && picture.x_log;
    line.y = c.reference.empty() ? c.computed : c.reference;
    line.label = c.label;
    plot.series.push_back(line);
    if (c.reference.empty()) continue;
    dots.y = c.computed;
    dots.style = app::Series::Style::dots;
    dots.size = c.x.size() > 60 ? 2 : 3;
    plot.series.push_back(dots);
  }
  plot.legend = picture.curves.size() > 1;
  return app::to_svg(plot) + '\n';
}

}  // namespace annulus::manual
