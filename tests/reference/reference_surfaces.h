// Meshes and Bezier surfaces of the reference tracer: all triangles, all patches, in extended precision.
#pragma once
#include "common/scene/asset.h"
#include "tests/reference/reference_solids.h"

namespace rayfarm::reference {

/// A mesh or a Bezier surface of a scene, which must outlive it.
struct Surface {
  const AssetContent* content = nullptr;
  bool smooth = false;  // a mesh with the normals of its corners
  bool closed = false;
};

Surface surface_of(const Mesh& mesh, const AssetContent& content);
Surface surface_of(const Bezier& bezier, const AssetContent& content);

/// All crossings of the line, ascending; gradients point to the front.
std::vector<Crossing> crossings_of(const Surface& surface, const Ray& local);

/// Of a closed surface: inside is where the line has come in more often than it has left.
Spans spans_of_closed(std::vector<Crossing> crossings, const Ray& local);

/// A sheet has no inside: each crossing is there twice.
Spans spans_of_sheet(const std::vector<Crossing>& crossings, const Ray& local);

}  // namespace rayfarm::reference
