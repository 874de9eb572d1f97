#pragma once

#include <optional>
#include <string>

#include "app/systems/planetary/point_stiffness.h"
#include "dynamics/spatial/carrier_structure.h"

/// What carrier and housing of a planetary stage give way, and the positions of its statics; SI.
namespace annulus::app {

/// Webs between two walls, or a matrix in a file.
struct CarrierStructureInput {
  std::optional<int> webs;
  std::optional<double> web_circle, web_length, web_width, web_depth, first_web;
  dynamics::Side shaft = dynamics::Side::low;
  bool mirrored = false;  ///< in a mirror image the first web is on the other side of planet 1
  std::optional<std::string> file;
  Eigen::MatrixXd stiffness{};  ///< that of the file: read_carrier_stiffness()
};

struct HousingInput {
  std::string file;
  PointStiffness seats{};  ///< that of the file; its points are columns of bearings
};

struct StaticsInput {
  std::optional<int> places;
  std::optional<int> phases;
};

/// Inputs of planetary stages alone (Scene::own).
struct StructureInput {
  std::optional<CarrierStructureInput> carrier;
  std::optional<HousingInput> housing;
  StaticsInput statics;
};

}  // namespace annulus::app
