#pragma once

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace annulus::app {

/// What one study will take.
struct StudyPlan {
  std::string name;    ///< "[[sweep]] 1", as in the scene
  std::string what;    ///< "stage.sun_speed_rpm from 500 to 2000 r/min, 31 values"
  long responses = 0;  ///< over all rings
  int tables = 0;      ///< stiffness tables to be solved besides the nominal ones
  double seconds = 0;  ///< rough wall time of the responses on one core, tables not counted
};

}  // namespace annulus::app
