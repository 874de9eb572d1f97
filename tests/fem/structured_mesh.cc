#include "structured_mesh.h"

#include <random>

namespace annulus::tests {

using geometry::Boundary;
using geometry::Mesh;

geometry::Mesh structured_mesh(int nu, int nv, const std::function<Eigen::Vector2d(double, double)>& map,
                               const SideTags& tags) {
  Mesh mesh;
  mesh.dimension = 2;
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nu + 1) + i); };
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const Eigen::Vector2d p = map(static_cast<double>(i) / nu, static_cast<double>(j) / nv);
      mesh.vertices.emplace_back(p.x(), p.y(), 0);
    }
  const auto face = [&](std::uint32_t a, std::uint32_t b, int side) {
    mesh.faces.push_back({{a, b, 0, 0}, tags.at(side)});
  };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) mesh.cells.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    face(id(0, j + 1), id(0, j), 0);
    face(id(nu, j), id(nu, j + 1), 1);
  }
  for (int i = 0; i < nu; ++i) {
    face(id(i, 0), id(i + 1, 0), 2);
    face(id(i + 1, nv), id(i, nv), 3);
  }
  mesh.regions.assign(mesh.cells.size(), Mesh::Region::rim);
  return mesh;
}

geometry::Mesh structured_mesh(int nu, int nv, int nw,
                               const std::function<Eigen::Vector3d(double, double, double)>& map,
                               const SideTags& tags) {
  Mesh mesh;
  mesh.dimension = 3;
  const auto id = [&](int i, int j, int k) { return static_cast<std::uint32_t>((k * (nv + 1) + j) * (nu + 1) + i); };
  for (int k = 0; k <= nw; ++k)
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i <= nu; ++i)
        mesh.vertices.push_back(
            map(static_cast<double>(i) / nu, static_cast<double>(j) / nv, static_cast<double>(k) / nw));
  for (int k = 0; k < nw; ++k)
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        const std::array<std::uint32_t, 8> c = {
            id(i, j, k),     id(i + 1, j, k),     id(i + 1, j + 1, k),     id(i, j + 1, k),
            id(i, j, k + 1), id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)};
        mesh.cells.push_back(c);
        const auto face = [&](bool exposed, int p, int q, int r, int s, int side) {
          if (exposed) mesh.faces.push_back({{c[p], c[q], c[r], c[s]}, tags.at(side)});
        };
        face(i == 0, 0, 4, 7, 3, 0);
        face(i == nu - 1, 1, 2, 6, 5, 1);
        face(j == 0, 0, 1, 5, 4, 2);
        face(j == nv - 1, 3, 7, 6, 2, 3);
        face(k == 0, 0, 3, 2, 1, 4);
        face(k == nw - 1, 4, 5, 6, 7, 5);
      }
  mesh.regions.assign(mesh.cells.size(), Mesh::Region::rim);
  return mesh;
}

geometry::Mesh distorted_box(int dimension, int n, double distortion) {
  SideTags tags;
  tags.fill(Boundary::inner);
  std::mt19937 random(1);  // its sequence is fixed by the standard
  const auto inside = [](double t) { return t > 0 && t < 1; };
  const auto shake = [&] { return distortion / n * (2.0 * random() / std::mt19937::max() - 1); };
  if (dimension == 2)
    return structured_mesh(
        n, n,
        [&](double u, double v) -> Eigen::Vector2d {
          if (!inside(u) || !inside(v)) return {u, v};
          const double x = u + shake();
          return {x, v + shake()};
        },
        tags);
  return structured_mesh(
      n, n, n,
      [&](double u, double v, double w) -> Eigen::Vector3d {
        if (!inside(u) || !inside(v) || !inside(w)) return {u, v, w};
        const double x = u + shake(), y = v + shake();
        return {x, y, w + shake()};
      },
      tags);
}

}  // namespace annulus::tests
