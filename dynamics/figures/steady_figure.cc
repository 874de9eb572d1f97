#include "dynamics/figures/steady_figure.h"

namespace annulus::dynamics {

FigureSpec steady_figure() {
  return {.key = "steady",
          .title = "Periodic",
          .definition = "1 where a periodic steady state was found, otherwise 0",
          .better = Better::larger};
}

}  // namespace annulus::dynamics
