#pragma once

#include <Eigen/Core>

#include "fem/closed_form/plane_moduli.h"

namespace annulus::fem {

/// A plain ring between two circles, per metre of width.
struct PlainRing {
  double inner_radius = 0, outer_radius = 0;  ///< m
  PlaneModuli moduli;
};

/// How a ring deforms under loads on its two circles that vary with the n-th circumferential harmonic.
///
/// Displacements u_r = U cos(n phi), u_theta = V sin(n phi), or turned by a quarter of a wave u_r = U sin(n phi),
/// u_theta = -V cos(n phi); loads per radian likewise. Rows and columns: (radial, tangential) on the inner circle, then
/// on the outer one; m per (N/m per rad). Symmetric. Rows of a held circle are zero.
///
/// A ring that nothing holds has an artificial stiffness against its rigid motions alone (harmonics 0 and 1): exact, up
/// to a rigid motion, for loads in equilibrium.
using HarmonicCompliance = Eigen::Matrix4d;

enum class HeldCircle { none, inner, outer };

/// Exact plane elasticity: solutions of Navier's equations in powers of r [Michell1899;
/// TimoshenkoGoodier1970, art. 43], four for each harmonic. [SainsotVelexDuverger2004] uses the same elastic ring for
/// the foundation of external teeth.
[[nodiscard]] HarmonicCompliance elastic_ring(const PlainRing& ring, int harmonic, HeldCircle held);

/// The ring as a curved beam (Winkler and Bach, with Timoshenko's shear): plane sections, nothing held.
///
/// Section displacement (u, w + (r - R) psi); strain (u + w' + (r - R) psi')/r, shear (u' - w + R psi)/r. With R the
/// radius of the neutral axis, h / ln(b/a), extension and bending separate, and the strain energy per radian is
///
///     1/2 [E' ln(b/a) (u + w')^2 + E' h e psi'^2 + 5/6 G ln(b/a) (u' - w + R psi)^2],   e = (a + b)/2 - R
///
/// [Timoshenko1956, ch. 12]. Exact for a constant rectangular section; good while the rim is thin
/// against the length of the wave.
[[nodiscard]] HarmonicCompliance curved_beam(const PlainRing& ring, int harmonic);

}  // namespace annulus::fem
