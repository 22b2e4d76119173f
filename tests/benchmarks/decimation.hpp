#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "slam/core/triangle_mesh.hpp"

namespace planum::testing {

/// The mesh as Debian's library has it.
using PackagedTriangles = OpenMesh::TriMesh_ArrayKernelT<>;

/// The same without a brake: the library is built with assertions, and two thirds of the time to
/// decimate go into those of is_collapse_ok(). This is the same test without them.
class OpenMeshTriangles : public PackagedTriangles {
 public:
  bool is_collapse_ok(OpenMesh::HalfedgeHandle v0v1) {
    const auto v1v0 = opposite_halfedge_handle(v0v1);
    const auto v0 = to_vertex_handle(v1v0), v1 = to_vertex_handle(v0v1);
    if (status(edge_handle(v0v1)).deleted() || status(v0).deleted() || status(v1).deleted())
      return false;
    if (hangs_by_a_corner(v0v1) || hangs_by_a_corner(v1v0)) return false;
    const auto left = apex(v0v1), right = apex(v1v0);
    if (left == right) return false;
    if (is_boundary(v0) && is_boundary(v1) && !is_boundary(v0v1) && !is_boundary(v1v0))
      return false;
    return share_no_neighbours(v0, v1, left, right);
  }

 private:
  /// Whether both other edges of the triangle at a half-edge are borders.
  bool hangs_by_a_corner(OpenMesh::HalfedgeHandle half) const {
    if (is_boundary(half)) return false;
    const auto next = next_halfedge_handle(half), last = next_halfedge_handle(next);
    return is_boundary(opposite_halfedge_handle(next)) &&
           is_boundary(opposite_halfedge_handle(last));
  }

  /// The third corner of the triangle at a half-edge, if there is one.
  OpenMesh::VertexHandle apex(OpenMesh::HalfedgeHandle half) const {
    return is_boundary(half) ? OpenMesh::VertexHandle()
                             : to_vertex_handle(next_halfedge_handle(half));
  }

  bool share_no_neighbours(OpenMesh::VertexHandle v0, OpenMesh::VertexHandle v1,
                           OpenMesh::VertexHandle left, OpenMesh::VertexHandle right) {
    for (const auto v : vv_range(v0)) status(v).set_tagged(false);
    for (const auto v : vv_range(v1)) status(v).set_tagged(true);
    for (const auto v : vv_range(v0))
      if (status(v).tagged() && v != left && v != right) return false;
    return true;
  }
};

/// A mesh for OpenMesh, and how many faces it did not take: those at complex edges and vertices.
template <class Mesh>
struct OpenMeshCopy {
  Mesh mesh;
  std::size_t refused = 0;
};

template <class Mesh>
OpenMeshCopy<Mesh> openmesh_copy(const TriangleMesh& mesh) {
  OpenMeshCopy<Mesh> copy;
  // The collapse of an edge marks what is gone.
  copy.mesh.request_vertex_status();
  copy.mesh.request_edge_status();
  copy.mesh.request_face_status();
  copy.mesh.reserve(mesh.vertices.size(), 3 * mesh.vertices.size(), mesh.triangles.size());
  std::vector<OpenMesh::VertexHandle> handles;
  handles.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices)
    handles.push_back(copy.mesh.add_vertex({v.x(), v.y(), v.z()}));
  omerr().disable();
  for (const auto& [a, b, c] : mesh.triangles)
    if (!copy.mesh.add_face(handles[a], handles[b], handles[c]).is_valid()) ++copy.refused;
  omerr().enable();
  return copy;
}

inline TriangleMesh mesh_from(const PackagedTriangles& mesh) {
  TriangleMesh result;
  for (const auto vertex : mesh.vertices()) {
    const auto& p = mesh.point(vertex);
    result.vertices.push_back({p[0], p[1], p[2]});
  }
  for (const auto face : mesh.faces()) {
    std::array<std::uint32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto vertex : mesh.fv_range(face))
      triangle[k++] = static_cast<std::uint32_t>(vertex.idx());
    result.triangles.push_back(triangle);
  }
  return result;
}

/// Melax, A simple, fast, and effective polygon reduction algorithm (Game Developer, November
/// 1998): the edge from u to v costs its length times the curvature around u,
///   |u - v| max over triangles f at u of min over triangles n at the edge of (1 - f.n) / 2.
template <class MeshT>
class ShortestEdgeModule : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  using Handle = OpenMesh::Decimater::ModHandleT<ShortestEdgeModule>;
  using Base = OpenMesh::Decimater::ModBaseT<MeshT>;
  using Base::mesh;

  explicit ShortestEdgeModule(MeshT& triangles) : Base(triangles, false) {
    mesh().request_face_normals();
  }
  ~ShortestEdgeModule() override { mesh().release_face_normals(); }
  ShortestEdgeModule(const ShortestEdgeModule&) = delete;
  ShortestEdgeModule& operator=(const ShortestEdgeModule&) = delete;

  /// The decimater keeps the normals up to date from then on.
  void initialize() override { mesh().update_face_normals(); }

  float collapse_priority(const typename Base::CollapseInfo& collapse) override {
    float curvature = 0;
    for (const auto face : mesh().vf_range(collapse.v0)) {
      float least = 1;
      for (const auto side : {collapse.fl, collapse.fr})
        if (side.is_valid())
          least = std::min(least, (1 - (mesh().normal(face) | mesh().normal(side))) / 2);
      curvature = std::max(curvature, least);
    }
    return (collapse.p1 - collapse.p0).norm() * curvature;
  }
};

template <class MeshT>
using QuadricModule = OpenMesh::Decimater::ModQuadricT<MeshT>;

/// Collapses edges, those first that cost least by the module, until so many triangles are left or
/// no edge can go without changing how the surface hangs together.
template <template <class> class Module, class Mesh>
void decimate(Mesh& mesh, std::size_t triangles) {
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  typename Module<Mesh>::Handle module;
  decimater.add(module);
  decimater.initialize();
  decimater.decimate_to_faces(0, triangles);
  mesh.garbage_collection();
}

}  // namespace planum::testing
