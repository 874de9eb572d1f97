#pragma once

#include <vector>

#include "fem/contact/contact_body.h"
#include "fem/contact/contact_face.h"
#include "fem/contact/tooth_pairs.h"
#include "fem/problem/material.h"

namespace annulus::fem {

class PlanetOnRollers;
class SupportRow;

/// Both bodies in contact over a face. Everything is referred to.
struct ContactBodies {
  const ContactFace& face;
  const ContactBody &pinion, &wheel;
  const SupportRow* supports = nullptr;      ///< of a wheel that floats
  const PlanetOnRollers* rollers = nullptr;  ///< of a planet that stands on them
};

struct PressureElementOptions {
  /// Pressure elements to either side of the centre of a pair, over a half-window of `window`: independent of the mesh,
  /// fine at the centre, so that a pair that carries little has its share of them too. Bodies whose mesh alone carries
  /// the elements have elements as short as it allows instead.
  int elements = 10;
  double first = 0.35;   ///< length of the elements at the centre relative to a uniform split
  double window = 1.25;  ///< half-length of a pair's contact window in Hertz half-widths of the whole load
};

/// Divides the contact windows of tooth pairs into pressure elements. Everything is referred to.
class PressureElements {
 public:
  PressureElements(const ContactBodies& bodies, const MeshMaterials& materials, const PressureElementOptions& options)
      : bodies_(bodies), materials_(materials), options_(options) {}

  /// Elements of `pair` where flanks face each other; `load` (N) of the whole mesh, `window` in Hertz half-widths of
  /// it.
  void add(ToothPair& pair, const FacingFlanks& facing, double load, double window) const;

 private:
  /// Distances of the elements' edges from the centre of a window towards one of its ends, `half` away, from 0 on. Arc
  /// lengths on the pinion: `centre`, and `direction` 1 or -1.
  [[nodiscard]] std::vector<double> edges(const ToothPair& pair, double centre, double direction, double half,
                                          int per_side) const;
  /// Length of the shortest element both flanks carry at a pinion arc length, m.
  [[nodiscard]] double shortest(const ToothPair& pair, double arc) const;

  ContactBodies bodies_;
  const MeshMaterials& materials_;
  PressureElementOptions options_;
};

/// m, transmission error at which facing flanks touch in a slice without load.
[[nodiscard]] double gap_without_load(const ContactFace& face, const FacingFlanks& facing, int slice);

}  // namespace annulus::fem
