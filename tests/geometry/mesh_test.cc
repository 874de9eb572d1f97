#include "geometry/mesh.h"

#include <gmsh.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/beast/core/detail/base64.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>

#include "core/files.h"
#include "gears.h"
#include "geometry/sector_mesh.h"
#include "geometry/vtu_file.h"

namespace annulus::geometry::test {

namespace {

constexpr double outside_radius = 331.8 * units::mm;
constexpr double sleeve_radius = 321.2 * units::mm;

Mesh ring_sector() {
  return make_sector_mesh(paper_ring(), {.support_radius = outside_radius, .circles = {sleeve_radius}},
                          {.flank_cells = 6, .fillet_cells = 2, .thickness_cells = 4, .root_cells = 1, .rim_cells = 3});
}

/// Volume enclosed by the faces (divergence theorem, faces as two triangles): that of the cells when the faces close
/// around them with the normals outwards. Exact where the faces are plane, as in an extruded body.
double volume_by_faces(const Mesh& mesh) {
  double volume = 0;
  for (const auto& face : mesh.faces) {
    const auto& v = face.vertices;
    const auto& p = mesh.vertices[v[0]];
    for (int i = 1; i < 3; ++i) volume += p.dot(mesh.vertices[v[i]].cross(mesh.vertices[v[i + 1]])) / 6;
  }
  return volume;
}

/// Of a plane quadrilateral.
double face_area(const Mesh& mesh, const Mesh::Face& face) {
  const auto& v = face.vertices;
  const Eigen::Vector3d d = mesh.vertices[v[2]] - mesh.vertices[v[0]];
  return 0.5 * d.cross(mesh.vertices[v[3]] - mesh.vertices[v[1]]).norm();
}

std::map<Boundary, int> count_faces(const Mesh& mesh) {
  std::map<Boundary, int> count;
  for (const auto& face : mesh.faces) ++count[face.boundary];
  return count;
}

Mesh single_cell(const std::vector<Eigen::Vector3d>& vertices) {
  Mesh mesh;
  mesh.dimension = vertices.size() == 4 ? 2 : 3;
  mesh.vertices = vertices;
  mesh.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  mesh.regions = {Mesh::Region::rim};
  return mesh;
}

struct TemporaryFolder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("annulus_mesh_test_" + std::to_string(std::random_device{}()));
  TemporaryFolder() { std::filesystem::create_directory(path); }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(mesh)

BOOST_AUTO_TEST_CASE(scaled_jacobian_and_measure_of_known_cells) {
  const double rounding = 1e-14;
  const auto close = boost::test_tools::tolerance(rounding);
  const Mesh rectangle = single_cell({{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}});
  BOOST_TEST(rectangle.worst_scaled_jacobian() == 1.0, close);
  BOOST_TEST(rectangle.area_or_volume() == 6.0, close);
  const Mesh rhombus = single_cell({{0, 0, 0}, {2, 0, 0}, {3, std::sqrt(3.0), 0}, {1, std::sqrt(3.0), 0}});
  BOOST_TEST(rhombus.worst_scaled_jacobian() == std::sqrt(0.75), close);  // 60 degrees
  const Mesh inverted = single_cell({{0, 0, 0}, {0, 2, 0}, {3, 2, 0}, {3, 0, 0}});
  BOOST_TEST(inverted.worst_scaled_jacobian() == -1.0, close);
  const Mesh box =
      single_cell({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3}});
  BOOST_TEST(box.worst_scaled_jacobian() == 1.0, close);
  BOOST_TEST(box.area_or_volume() == 6.0, close);
  const Mesh sheared =
      single_cell({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}});
  BOOST_TEST(sheared.worst_scaled_jacobian() == std::sqrt(0.5), close);  // 45 degrees
  BOOST_TEST(sheared.area_or_volume() == 1.0, close);
  // A frustum with bottom side 2, top side 1, height 1: (4 + 2 + 1) / 3.
  const Mesh frustum = single_cell(
      {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-.5, -.5, 1}, {.5, -.5, 1}, {.5, .5, 1}, {-.5, .5, 1}});
  BOOST_TEST(frustum.area_or_volume() == 7.0 / 3, close);
}

BOOST_AUTO_TEST_CASE(repeated_sectors_share_their_sides) {
  const Mesh sector = ring_sector();
  const auto side = static_cast<std::size_t>(count_faces(sector)[Boundary::side_low]) + 1;  // vertices
  for (const int count : {1, 2, 7, 162}) {
    const Mesh part = repeat(sector, 162, count);
    const std::size_t shared = count == 162 ? 162 : static_cast<std::size_t>(count) - 1;
    BOOST_TEST(part.vertices.size() == count * sector.vertices.size() - shared * side);
    BOOST_TEST(part.cells.size() == count * sector.cells.size());
    BOOST_TEST(part.regions.size() == part.cells.size());
    auto faces = count_faces(part);
    BOOST_TEST(faces[Boundary::side_low] == (count == 162 ? 0 : static_cast<int>(side) - 1));
    BOOST_TEST(faces[Boundary::side_high] == faces[Boundary::side_low]);
    BOOST_TEST(faces[Boundary::leading_flank] == count * 6);
    BOOST_TEST(part.area_or_volume() == count * sector.area_or_volume(),
               boost::test_tools::tolerance(1e-12));  // rounding
    BOOST_TEST(part.worst_scaled_jacobian() == sector.worst_scaled_jacobian(), boost::test_tools::tolerance(1e-9));
    // Every edge belongs to two cells or is a boundary face: nothing is left unmerged.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& cell : part.cells) {
      for (int i = 0; i < 4; ++i) ++edges[std::minmax({cell[i], cell[(i + 1) % 4]})];
    }
    const auto open = std::ranges::count_if(edges, [](const auto& e) { return e.second == 1; });
    BOOST_TEST(open == static_cast<long>(part.faces.size()));
  }
  // Counter-clockwise: the second copy lies one pitch further.
  const Mesh two = repeat(sector, 162, 2);
  const auto& first = two.vertices[two.cells[0][0]];
  const auto& second = two.vertices[two.cells[sector.cells.size()][0]];
  const Eigen::Vector3d turned = Eigen::AngleAxisd(2 * std::numbers::pi / 162, Eigen::Vector3d::UnitZ()) * first;
  BOOST_TEST((turned - second).norm() < 1e-12);
}

BOOST_AUTO_TEST_CASE(extruded_prism) {
  const Mesh sector = ring_sector();
  const Mesh solid = extrude(sector, {{.z_low = 0, .z_high = 0.04, .cells = 3, .grading = 4}});
  BOOST_TEST(solid.cells.size() == 3 * sector.cells.size());
  BOOST_TEST(solid.vertices.size() == 4 * sector.vertices.size());
  BOOST_TEST(solid.area_or_volume() == 0.04 * sector.area_or_volume(), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(volume_by_faces(solid) == solid.area_or_volume(), boost::test_tools::tolerance(1e-9));  // r^2 z cancels
  BOOST_TEST(solid.worst_scaled_jacobian() == sector.worst_scaled_jacobian(), boost::test_tools::tolerance(1e-9));
  auto plane_faces = count_faces(sector);
  auto faces = count_faces(solid);
  BOOST_TEST(faces[Boundary::leading_flank] == 3 * plane_faces[Boundary::leading_flank]);
  BOOST_TEST(faces[Boundary::side_low] == 3 * plane_faces[Boundary::side_low]);
  BOOST_TEST(faces[Boundary::end_low] == static_cast<int>(sector.cells.size()));
  BOOST_TEST(faces[Boundary::end_high] == static_cast<int>(sector.cells.size()));
  BOOST_TEST(faces[Boundary::inner] == 0);
  // Layers of 1, 2 and 4 sevenths.
  std::set<double> levels;
  for (const auto& v : solid.vertices) levels.insert(std::round(v.z() * 7 / 0.04 * 1e6) / 1e6);
  BOOST_TEST((levels == std::set<double>{0, 1, 3, 7}));
}

BOOST_AUTO_TEST_CASE(sleeve_below_the_teeth) {
  const Mesh sector = ring_sector();
  double sleeve_area = 0;
  std::size_t sleeve_cells = 0;
  for (std::size_t c = 0; c < sector.cells.size(); ++c) {
    Mesh one = sector;
    one.cells = {sector.cells[c]};
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) centre += sector.vertices[sector.cells[c][i]] / 4;
    if (centre.norm() < sleeve_radius) continue;
    sleeve_area += one.area_or_volume();
    ++sleeve_cells;
  }
  const Mesh solid = extrude(sector, {{.z_low = -0.018,
                                       .z_high = 0,
                                       .cells = 2,
                                       .region = Mesh::Region::sleeve,
                                       .toothed = false,
                                       .radius_low = sleeve_radius},
                                      {.z_low = 0, .z_high = 0.088, .cells = 4}});
  BOOST_TEST(solid.cells.size() == 2 * sleeve_cells + 4 * sector.cells.size());
  BOOST_TEST(solid.area_or_volume() == 0.018 * sleeve_area + 0.088 * sector.area_or_volume(),
             boost::test_tools::tolerance(1e-12));
  BOOST_TEST(volume_by_faces(solid) == solid.area_or_volume(), boost::test_tools::tolerance(1e-9));
  auto faces = count_faces(solid);
  BOOST_TEST(faces[Boundary::end_low] == static_cast<int>(sleeve_cells));
  BOOST_TEST(faces[Boundary::end_high] == static_cast<int>(sector.cells.size()));
  const int across = 4 + 2 + 2;  // cells along the sleeve's inside: thickness, two half fillets, two root lands
  BOOST_TEST(faces[Boundary::inner] == static_cast<int>(sector.cells.size() - sleeve_cells) + 2 * across);
  for (const auto& face : solid.faces) {
    if (face.boundary != Boundary::end_low) continue;
    for (const auto v : face.vertices) BOOST_TEST(solid.vertices[v].z() == -0.018);
  }
  BOOST_TEST(std::ranges::count(solid.regions, Mesh::Region::sleeve) == static_cast<long>(2 * sleeve_cells));
  BOOST_TEST(std::ranges::count(solid.regions, Mesh::Region::tooth) > 0);
  // A solid sector repeats like a plane one.
  const Mesh three = repeat(solid, 162, 3);
  BOOST_TEST(three.area_or_volume() == 3 * solid.area_or_volume(), boost::test_tools::tolerance(1e-12));
  BOOST_TEST(volume_by_faces(three) == three.area_or_volume(), boost::test_tools::tolerance(1e-9));
}

// Between two levels the vertices run straight while the section turns by theta: the section half way shrinks, and the
// volume is the straight one times (2 + cos theta) / 3, less by theta^2 / 6.
BOOST_AUTO_TEST_CASE(twisted_extrusion) {
  constexpr double width = 88 * units::mm;
  constexpr double support = 340 * units::mm;
  const Gear gear(helical(paper_gear(GearKind::internal, 162, 0.1516), 14 * units::deg));
  const ToothProfile profile(gear);
  const Mesh sector =
      make_sector_mesh(gear, {.support_radius = support},
                       {.flank_cells = 6, .fillet_cells = 2, .thickness_cells = 4, .root_cells = 1, .rim_cells = 3});
  const double straight = width * sector.area_or_volume();
  std::vector<double> errors;
  for (const int cells : {4, 8}) {
    const Mesh solid = extrude(sector, {{.z_low = 0, .z_high = width, .cells = cells}}, {.twist = profile.twist()});
    const double theta = profile.twist() * width / cells;
    BOOST_TEST(solid.area_or_volume() == straight * (2 + std::cos(theta)) / 3,
               boost::test_tools::tolerance(1e-10));  // r^2 cancels
    errors.push_back(1 - solid.area_or_volume() / straight);
    BOOST_TEST(solid.worst_scaled_jacobian() > 0.5);

    double off_surface = 0;
    for (const auto& face : solid.faces) {
      for (const auto v : face.vertices) {
        const auto& p = solid.vertices[v];
        off_surface = std::max(off_surface, (profile.project_solid(face.boundary, p, support) - p).norm());
      }
    }
    BOOST_TEST(off_surface < 1e-12);
    auto faces = count_faces(solid);
    auto plane_faces = count_faces(sector);
    BOOST_TEST(faces[Boundary::leading_flank] == cells * plane_faces[Boundary::leading_flank]);
    // The sides match, so that sectors share them; a closed ring has none left.
    const Mesh two = repeat(solid, 162, 2);
    BOOST_TEST(two.vertices.size() ==
               2 * solid.vertices.size() - (plane_faces[Boundary::side_low] + 1) * static_cast<std::size_t>(cells + 1));
    const Mesh ring = repeat(solid, 162, 162);
    BOOST_TEST(ring.area_or_volume() == 162 * solid.area_or_volume(), boost::test_tools::tolerance(1e-10));
    BOOST_TEST(count_faces(ring)[Boundary::side_low] == 0);
  }
  BOOST_TEST(std::abs(errors[0] / errors[1] - 4) < 0.01);  // second order
}

// Rings of the paper with a hoop at the free end and with a flange at the low end. The area of a straight-sided annulus
// with the same angular cuts on both circles is known in closed form; so are the areas of the exposed faces.
BOOST_AUTO_TEST_CASE(hoop_and_flange_around_the_ring) {
  constexpr double width = 88 * units::mm;
  constexpr double band_width = 20 * units::mm;
  constexpr double band_radius = 350 * units::mm;
  constexpr double sleeve_length = 18 * units::mm;
  const Mesh plane =
      make_sector_mesh(paper_ring(), {.support_radius = band_radius, .circles = {sleeve_radius, outside_radius}},
                       {.flank_cells = 6, .fillet_cells = 2, .thickness_cells = 4, .root_cells = 2, .rim_cells = 7});
  std::set<double> cuts;
  for (const auto& v : plane.vertices) {
    if (std::abs(v.norm() - outside_radius) < 1e-9) cuts.insert(std::atan2(v.y(), v.x()));
  }
  BOOST_REQUIRE(cuts.size() == 4u + 4 + 2 + 1);  // land, half fillet, tooth, half fillet, land
  double double_area = 0;                        // of the polygon per radius^2
  for (auto a = cuts.begin(), b = std::next(a); b != cuts.end(); ++a, ++b) double_area += std::sin(*b - *a);
  const auto annulus = [&](double inside, double outside) {
    return 0.5 * double_area * (outside * outside - inside * inside);
  };
  const auto area_inside = [&](double radius) { return plane.area_or_volume() - annulus(radius, band_radius); };
  const double ring_area = area_inside(outside_radius);
  const double sleeve_area = annulus(sleeve_radius, outside_radius);
  const double band_area = annulus(outside_radius, band_radius);
  const auto rounding = boost::test_tools::tolerance(1e-11);  // r^2 cancels

  const Layers sleeve{.z_low = -sleeve_length,
                      .z_high = 0,
                      .cells = 2,
                      .region = Mesh::Region::sleeve,
                      .toothed = false,
                      .radius_low = sleeve_radius,
                      .radius_high = outside_radius};
  const Mesh hooped = extrude(plane,
                              {sleeve,
                               {.z_low = 0, .z_high = width - band_width, .cells = 3, .radius_high = outside_radius},
                               {.z_low = width - band_width, .z_high = width, .cells = 2}},
                              {.outside_radius = outside_radius});
  const Mesh flanged = extrude(plane,
                               {{.z_low = 0, .z_high = band_width, .cells = 2, .band = Mesh::Region::flange},
                                {.z_low = band_width, .z_high = width, .cells = 3, .radius_high = outside_radius}},
                               {.outside_radius = outside_radius});
  const double arc = [&] {  // of the polygon per radius
    double sum = 0;
    for (auto a = cuts.begin(), b = std::next(a); b != cuts.end(); ++a, ++b) sum += 2 * std::sin((*b - *a) / 2);
    return sum;
  }();
  for (const bool hoop : {true, false}) {
    const Mesh& mesh = hoop ? hooped : flanged;
    const double below = hoop ? sleeve_length : 0;
    const auto band_region = hoop ? Mesh::Region::hoop : Mesh::Region::flange;
    BOOST_TEST(mesh.area_or_volume() == below * sleeve_area + width * ring_area + band_width * band_area, rounding);
    BOOST_TEST(volume_by_faces(mesh) == mesh.area_or_volume(), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(mesh.worst_scaled_jacobian() == plane.worst_scaled_jacobian(), boost::test_tools::tolerance(1e-9));
    std::map<Mesh::Region, double> volume;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      Mesh one;
      one.dimension = 3;
      one.vertices = mesh.vertices;
      one.cells = {mesh.cells[c]};
      volume[mesh.regions[c]] += one.area_or_volume();
    }
    BOOST_TEST(volume[band_region] == band_width * band_area, rounding);
    BOOST_TEST(volume[hoop ? Mesh::Region::flange : Mesh::Region::hoop] == 0);
    BOOST_TEST(volume[Mesh::Region::sleeve] == below * sleeve_area, rounding);
    BOOST_TEST(volume[Mesh::Region::tooth] + volume[Mesh::Region::rim] == width * ring_area, rounding);

    std::map<Boundary, double> area;
    for (const auto& face : mesh.faces) area[face.boundary] += face_area(mesh, face);
    BOOST_TEST(area[Boundary::support] == arc * band_radius * band_width, rounding);
    BOOST_TEST(area[Boundary::outside] == arc * outside_radius * (width - band_width + below), rounding);
    BOOST_TEST(area[Boundary::flange_face] == (hoop ? 0 : band_area), rounding);
    BOOST_TEST(area[Boundary::end_low] == (hoop ? sleeve_area : ring_area), rounding);
    BOOST_TEST(area[Boundary::end_high] == ring_area + (hoop ? band_area : 0), rounding);
    const double inside_of_sleeve = arc * sleeve_radius * below + (hoop ? area_inside(sleeve_radius) : 0);
    BOOST_TEST(area[Boundary::inner] == inside_of_sleeve + band_area, rounding);
    for (const auto& face : mesh.faces) {
      if (face.boundary != Boundary::flange_face) continue;
      for (const auto v : face.vertices) BOOST_TEST(mesh.vertices[v].z() == 0);
    }
    const Mesh three = repeat(mesh, 162, 3);
    BOOST_TEST(volume_by_faces(three) == 3 * mesh.area_or_volume(), boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(written_msh_reads_back) {
  const TemporaryFolder folder;
  const Mesh plane = ring_sector();
  for (const Mesh& written : {plane, extrude(plane, {{.z_low = 0, .z_high = 0.01, .cells = 2}})}) {
    const auto file = folder.path / "sector.msh";
    write_msh(written, file);
    gmsh::open(file.string());
    std::vector<std::size_t> tags;
    std::vector<double> coordinates;
    std::vector<double> parameters;
    gmsh::model::mesh::getNodes(tags, coordinates, parameters);
    BOOST_TEST(tags.size() == written.vertices.size());
    std::size_t cells = 0;
    std::map<std::string, std::size_t> groups;
    gmsh::vectorpair physical;
    gmsh::model::getPhysicalGroups(physical);
    for (const auto& [dimension, group] : physical) {
      std::string name;
      gmsh::model::getPhysicalName(dimension, group, name);
      std::vector<int> entities;
      gmsh::model::getEntitiesForPhysicalGroup(dimension, group, entities);
      for (const int entity : entities) {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> elements;
        std::vector<std::vector<std::size_t>> nodes;
        gmsh::model::mesh::getElements(types, elements, nodes, dimension, entity);
        for (const auto& e : elements) groups[name] += e.size();
        if (dimension == written.dimension) {
          for (const auto& e : elements) cells += e.size();
        }
      }
    }
    BOOST_TEST(cells == written.cells.size());
    auto faces = count_faces(written);
    BOOST_TEST(groups["leading_flank"] == static_cast<std::size_t>(faces[Boundary::leading_flank]));
    BOOST_TEST(groups["support"] == static_cast<std::size_t>(faces[Boundary::support]));
    BOOST_TEST(groups["tooth"] + groups["rim"] == cells);
    // Extreme coordinates survive to the last digit but the rounding of the text form (17 digits).
    double radius = 0;
    for (std::size_t i = 0; i < tags.size(); ++i)
      radius = std::max(radius, std::hypot(coordinates[3 * i], coordinates[3 * i + 1]));
    BOOST_TEST(radius == outside_radius, boost::test_tools::tolerance(1e-14));
    gmsh::model::remove();
  }
  BOOST_CHECK_THROW(write_msh(plane, folder.path / "missing" / "sector.msh"), Error);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path)) ++files;
  BOOST_TEST(files == 1);  // no temporary file is left behind
}

/// The numbers of an array of a VTU file, decoded by Boost.Beast and zlib.
template <class Number>
std::vector<Number> array_of(const std::string& text, const std::string& name) {
  namespace base64 = boost::beast::detail::base64;
  const auto begin = text.find('>', text.find("Name=\"" + name + "\"")) + 2;
  const auto digits = text.substr(begin, text.find('\n', begin) - begin);
  const auto decoded = [&](const std::string& part) {
    std::string raw(base64::decoded_size(part.size()), '\0');
    raw.resize(base64::decode(raw.data(), part.data(), part.size()).first);
    return raw;
  };
  // 16 bytes of a header for one block make 24 digits.
  const auto head = decoded(digits.substr(0, 24)), packed = decoded(digits.substr(24));
  std::array<std::uint32_t, 4> header{};  // blocks, bytes of each, of a partial one, compressed bytes
  BOOST_REQUIRE(head.size() == sizeof header);
  std::memcpy(header.data(), head.data(), sizeof header);
  BOOST_REQUIRE((header[0] == 1 && header[2] == 0 && header[3] == packed.size()));
  std::vector<Number> values(header[1] / sizeof(Number));
  uLongf bytes = header[1];
  BOOST_REQUIRE(::uncompress(reinterpret_cast<Bytef*>(values.data()), &bytes,
                             reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  BOOST_REQUIRE(bytes == header[1]);
  return values;
}

BOOST_AUTO_TEST_CASE(written_vtu_holds_the_cells) {
  const TemporaryFolder folder;
  const Mesh plane = ring_sector();
  write_vtu(plane, folder.path / "sector.vtu");
  const std::string s = read_file(folder.path / "sector.vtu");
  BOOST_TEST(s.find("NumberOfPoints=\"" + std::to_string(plane.vertices.size()) + "\" NumberOfCells=\"" +
                    std::to_string(plane.cells.size()) + "\"") != std::string::npos);
  const auto connectivity = array_of<std::int32_t>(s, "connectivity"), offsets = array_of<std::int32_t>(s, "offsets");
  BOOST_TEST(connectivity.size() == 4 * plane.cells.size());
  BOOST_TEST(offsets.back() == static_cast<int>(4 * plane.cells.size()));
  BOOST_TEST(static_cast<int>(array_of<std::uint8_t>(s, "types").front()) == 9);  // VTK_QUAD
  const auto points = array_of<double>(s, "Points");
  const std::size_t last = plane.vertices.size() - 1;
  BOOST_TEST(points.size() == 3 * plane.vertices.size());
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(points[3 * last + i] == plane.vertices[last][static_cast<long>(i)]);
  BOOST_TEST(connectivity.back() == static_cast<int>(plane.cells.back()[3]));
  const auto regions = array_of<std::int32_t>(s, "region");
  BOOST_TEST(regions.size() == plane.cells.size());
  BOOST_TEST(regions.front() == static_cast<int>(plane.regions.front()));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus::geometry::test
