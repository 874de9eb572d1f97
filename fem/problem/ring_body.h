#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace annulus::fem {

/// The surface that a housing holds; `none`: the ring floats on single supports.
enum class HeldSurface { none, outside, low_end_face, both_end_faces, flange_face };

/// A toothless continuation of the rim below the teeth; its lower end face is held. Length 0: the teeth start there.
struct Sleeve {
  double length = 0;     ///< m, axial
  double thickness = 0;  ///< m, radial, inwards from the outside diameter
};

/// A toothless band around the outside of the rim at its upper end.
struct Hoop {
  double width = 0;      ///< m, axial
  double thickness = 0;  ///< m, radial, beyond the outside diameter
};

/// A toothless band around the outside of the rim at its lower end.
struct Flange {
  double width = 0;           ///< m, axial, from the lower end face of the teeth
  double outside_radius = 0;  ///< m
};

/// Elastic body of a ring beside teeth and rim, and the surface that is held.
struct RingBody {
  HeldSurface held = HeldSurface::outside;
  double held_inner_radius = 0;  ///< m, of held end faces: they are held from here to the outside radius
  std::optional<Sleeve> sleeve{};
  std::optional<Hoop> hoop{};
  std::optional<Flange> flange{};
};

/// What plan, report and messages say about a structure.
struct RingWords {
  std::string name;                   ///< kind: "pins"; part of the identity of a mesh
  std::string description;            ///< "24 pins", "held by a flange"
  std::string plane_reason{};         ///< why a plane model suffices; empty where it does not
  std::string solid_reason{};         ///< why a solid model is needed; empty where it is not
  std::string asymmetry{};            ///< why the ring is not symmetric about the middle of the face; empty when it is
  std::string repetition{};           ///< single supports, as in "162 teeth on 24 equal supports"
  std::string support{}, supports{};  ///< single supports: "pin", "pins"
  std::string map_caption{};          ///< meaning of the colours in the map of support forces, after the word "pin"
};

/// Which force of a single support the map of the report shows.
enum class ShownForce { radial, resultant };

/// What a drawing needs beside the body.
struct RingDrawing {
  /// Equal cylinders parallel to the axis: pins, bolts, dowels.
  struct Cylinders {
    std::string name;            ///< "pins", singular where there is one
    std::vector<double> angles;  ///< rad, from the centre of tooth 0
    double circle_radius = 0;    ///< m, through their axes
    double diameter = 0;         ///< m
  };
  /// Teeth around the outside, as wide as their spaces.
  struct OutsideTeeth {
    std::string name;
    std::vector<double> angles;  ///< rad, from the centre of tooth 0
    double flank_angle = 0;      ///< rad, between flank and radius
  };
  enum class Bore { none, around_outside };

  std::vector<Cylinders> cylinders{};
  std::optional<OutsideTeeth> teeth{};
  Bore bore = Bore::none;
  ShownForce shown_force = ShownForce::radial;
};

/// All about a structure but the stiffness of its supports.
struct RingDescription {
  RingBody body{};
  RingWords words{};
  /// Parameters on which a solution depends, by name, SI.
  std::vector<std::pair<std::string, double>> parameters{};
  RingDrawing drawing{};
  std::vector<double> support_angles{};  ///< rad, of pins, bolts or spline teeth, from the centre of tooth 0
  bool opens = false;                    ///< supports touch and part as planets pass: their effects do not add up
};

}  // namespace annulus::fem
