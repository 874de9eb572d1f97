#pragma once

#include "app/model/dynamics_members.h"
#include "app/systems/shared/space_results.h"
#include "dynamics/spatial/linear_supports.h"

/// Bearings, loads and faces of bodies in space, and what they do in motion (core/bytes.h).
namespace annulus {

ANNULUS_MEMBERS(dynamics::StageBody, kind, planet);
ANNULUS_MEMBERS(dynamics::RollingRow, element, count, diameter, length, pitch_diameter, contact_angle, clearance,
                inner_groove, outer_groove, ring);
ANNULUS_MEMBERS(dynamics::StageBearing, name, body, on, place, beside, x, y, axial, tilt, play, load_zone, axial_play,
                tilt_play, distance, force, row, seat, matrix);
ANNULUS_MEMBERS(dynamics::LinearBearing, name, body, on, place, stiffness, rigid, preload, standing, law, law_axes);
ANNULUS_MEMBERS(dynamics::BearingsInSeries::Seated, bearing, first, place);
ANNULUS_MEMBERS(dynamics::BearingsInSeries::Spring, coordinate, stiffness);
ANNULUS_MEMBERS(dynamics::BearingsInSeries, motions, below, held, bearings, springs);
ANNULUS_MEMBERS(dynamics::LinearCoupling, name, bearings, stiffness, turned, turning_preload, law);
ANNULUS_MEMBERS(dynamics::SpaceLoad, body, load);
ANNULUS_MEMBERS(dynamics::StandingLoad, body, cosine, sine);
ANNULUS_MEMBERS(dynamics::SpaceSupports, laws, bearings, couplings, loads, standing_loads);
ANNULUS_MEMBERS(FaceShape, slope, curvature, gap_slope, tilted);
ANNULUS_MEMBERS(dynamics::SpreadFace, width, middle, gap, shape);
ANNULUS_MEMBERS(app::SpaceResults::Bearing, name, radial_mean, radial_max, axial_mean, axial_max, moment_max,
                law_deviation, table_end);
ANNULUS_MEMBERS(app::SpaceResults::FaceMoment, cycles, force, tilt, place);
ANNULUS_MEMBERS(app::SpaceResults::Mesh, name, place_mean, place_min, place_max, face_width, solid_face, moments);
ANNULUS_MEMBERS(app::SpaceResults::Face, mesh, factor, error, deviation, at, line_load);
ANNULUS_MEMBERS(app::SpaceResults, bearings, meshes, faces, table);

}  // namespace annulus
