// OpenMesh's binary format, read by OpenMesh. No other file includes OpenMesh.
//
// OpenMesh trusts its input. So it gets a copy that om_chunks has checked and cut down to header,
// positions, connectivity and face status. Indices are checked after OpenMesh has read them.

#include "libvox/core/error.h"
#include "libvox/io/mesh_formats.h"
#include "libvox/io/om_chunks.h"

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/OMReader.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <OpenMesh/Core/System/omstream.hh>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vox {

namespace {

namespace om = OpenMesh;

// Collects the elements that OpenMesh's reader delivers, without any checks: these follow when the
// reader has finished.
class Importer : public om::IO::BaseImporter {
 public:
  struct Halfedge {
    int toVertex = -1;
    int next = -1;
    int face = -1;
  };

  std::vector<Vec3d> points;
  std::vector<Halfedge> halfedges;
  std::vector<int> faceHalfedges;          // since version 2: a half-edge of each face
  std::vector<bool> deletedFaces;          // empty, or one per face
  std::vector<std::size_t> offsets = {0};  // before version 2: polygons
  std::vector<int> polygonVertices;

  om::VertexHandle add_vertex(const om::Vec3f& p) override { return add_vertex(om::Vec3d(p)); }
  om::VertexHandle add_vertex(const om::Vec3d& p) override {
    points.emplace_back(p[0], p[1], p[2]);
    return om::VertexHandle(static_cast<int>(points.size()) - 1);
  }
  om::HalfedgeHandle add_edge(om::VertexHandle from, om::VertexHandle to) override {
    const om::HalfedgeHandle first(static_cast<int>(halfedges.size()));
    halfedges.push_back({to.idx(), -1, -1});
    halfedges.push_back({from.idx(), -1, -1});
    return first;
  }
  void set_next(om::HalfedgeHandle h, om::HalfedgeHandle next) override {
    halfedges.at(static_cast<std::size_t>(h.idx())).next = next.idx();
  }
  void set_face(om::HalfedgeHandle h, om::FaceHandle face) override {
    halfedges.at(static_cast<std::size_t>(h.idx())).face = face.idx();
  }
  om::FaceHandle add_face(om::HalfedgeHandle h) override {
    faceHalfedges.push_back(h.idx());
    return om::FaceHandle(static_cast<int>(faceHalfedges.size()) - 1);
  }
  om::FaceHandle add_face(const VHandles& vertices) override {
    for (const om::VertexHandle v : vertices) polygonVertices.push_back(v.idx());
    offsets.push_back(polygonVertices.size());
    return om::FaceHandle(static_cast<int>(offsets.size()) - 2);
  }
  void set_status(om::FaceHandle face, const om::Attributes::StatusInfo& status) override {
    deletedFaces.resize(static_cast<std::size_t>(face.idx()) + 1);
    deletedFaces.back() = status.deleted();
  }

  om::BaseKernel* kernel() override { return &kernel_; }  // the reader needs one
  std::size_t n_vertices() const override { return points.size(); }
  std::size_t n_edges() const override { return halfedges.size() / 2; }
  std::size_t n_faces() const override {
    return std::max(faceHalfedges.size(), offsets.size() - 1);
  }

  // The rest of the interface is for attributes, which ChunkFilter has removed.
  using V = om::VertexHandle;
  using H = om::HalfedgeHandle;
  using E = om::EdgeHandle;
  using F = om::FaceHandle;
  using Status = om::Attributes::StatusInfo;
  om::VertexHandle add_vertex() override { return add_vertex(om::Vec3d(0, 0, 0)); }
  void set_point(V, const om::Vec3f&) override {}
  void set_halfedge(V, H) override {}
  void set_normal(V, const om::Vec3f&) override {}
  void set_normal(V, const om::Vec3d&) override {}
  void set_normal(F, const om::Vec3f&) override {}
  void set_normal(F, const om::Vec3d&) override {}
  void set_color(V, const om::Vec3uc&) override {}
  void set_color(V, const om::Vec4uc&) override {}
  void set_color(V, const om::Vec3f&) override {}
  void set_color(V, const om::Vec4f&) override {}
  void set_color(E, const om::Vec3uc&) override {}
  void set_color(E, const om::Vec4uc&) override {}
  void set_color(E, const om::Vec3f&) override {}
  void set_color(E, const om::Vec4f&) override {}
  void set_color(F, const om::Vec3uc&) override {}
  void set_color(F, const om::Vec4uc&) override {}
  void set_color(F, const om::Vec3f&) override {}
  void set_color(F, const om::Vec4f&) override {}
  void set_texcoord(V, const om::Vec2f&) override {}
  void set_texcoord(V, const om::Vec3f&) override {}
  void set_texcoord(H, const om::Vec2f&) override {}
  void set_texcoord(H, const om::Vec3f&) override {}
  void set_status(V, const Status&) override {}
  void set_status(H, const Status&) override {}
  void set_status(E, const Status&) override {}
  void add_face_texcoords(F, V, const std::vector<om::Vec2f>&) override {}
  void add_face_texcoords(F, V, const std::vector<om::Vec3f>&) override {}
  void set_face_texindex(F, int) override {}
  void request_face_texcoords2D() override {}
  void add_texture_information(int, std::string) override {}

 private:
  om::BaseKernel kernel_;
};

// Keeps OpenMesh's messages off the terminal while it lives.
class Silence {
 public:
  Silence() : logged_(omlog().is_enabled()), reported_(omerr().is_enabled()) {
    omlog().disable();
    omerr().disable();
  }
  ~Silence() {
    if (logged_) omlog().enable();
    if (reported_) omerr().enable();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  bool logged_, reported_;
};

// OpenMesh's reader is a global object with state, so only one thread at a time may use it.
bool readByOpenMesh(std::string file, Importer& importer) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const Silence silence;
  std::istringstream stream(std::move(file), std::ios::binary);
  om::IO::Options options(om::IO::Options::Status);
  return om::IO::OMReader().read(stream, importer, options);
}

class FaceBuilder {
 public:
  FaceBuilder(Importer& imported, ReadReport& report)
      : imported_(imported), report_(report), used_(imported.halfedges.size()) {
    mesh_.points = std::move(imported.points);
  }

  PolygonMesh build() {
    for (std::size_t f = 0; f + 1 < imported_.offsets.size(); ++f) addPolygon(f);
    for (std::size_t f = 0; f < imported_.faceHalfedges.size(); ++f)
      if (!isDeleted(f)) addLoop(f);
    return std::move(mesh_);
  }

 private:
  bool isDeleted(std::size_t f) const {
    return f < imported_.deletedFaces.size() && imported_.deletedFaces[f];
  }

  void addVertex(std::size_t f, int v) {
    if (v < 0 || static_cast<std::size_t>(v) >= mesh_.points.size())
      fail(f, "refers to vertex " + std::to_string(v) + " of " +
                  std::to_string(mesh_.points.size()) + " (numbered from 0)");
    mesh_.faceVertices.push_back(static_cast<Index>(v));
  }

  void addPolygon(std::size_t f) {
    for (std::size_t i = imported_.offsets[f]; i < imported_.offsets[f + 1]; ++i)
      addVertex(f, imported_.polygonVertices[i]);
    endFace(f);
  }

  // Drops the face if it is too short.
  void endFace(std::size_t f) {
    const Index begin = mesh_.faceOffsets.back();
    if (mesh_.cornerCount() < begin + 3) {
      mesh_.faceVertices.resize(begin);
      report_.add(Oddity::kShortFace, 0, f);
      return;
    }
    mesh_.faceOffsets.push_back(mesh_.cornerCount());
  }

  // Walks the half-edges of a face. Each half-edge may be met once in all, so that damaged links
  // cannot make the walk endless.
  void addLoop(std::size_t f) {
    const int first = imported_.faceHalfedges[f];
    int h = first;
    do {
      if (h < 0 || static_cast<std::size_t>(h) >= used_.size())
        fail(f, "refers to half-edge " + std::to_string(h) + " of " + std::to_string(used_.size()));
      const auto index = static_cast<std::size_t>(h);
      const Importer::Halfedge& halfedge = imported_.halfedges[index];
      if (used_[index] || halfedge.face != static_cast<int>(f))
        fail(f, "is damaged: its half-edges form no loop of their own");
      used_[index] = true;
      addVertex(f, halfedge.toVertex);
      h = halfedge.next;
    } while (h != first);
    endFace(f);
  }

  [[noreturn]] void fail(std::size_t f, const std::string& what) const {
    throw InputError(report_.file + ": face " + std::to_string(f) + " " + what);
  }

  const Importer& imported_;
  ReadReport& report_;
  std::vector<bool> used_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh parseOm(std::string_view data, ReadLog& log) {
  const std::string& fileName = log.report.file;
  OmMesh file = omMeshOnly(data, fileName);
  Importer imported;
  const bool complete = readByOpenMesh(std::move(file.bytes), imported);
  if (!complete || imported.points.size() != file.vertexCount ||
      imported.n_faces() != file.faceCount)
    throw InputError(fileName + ": OpenMesh cannot read it; save it as PLY or OBJ");
  return FaceBuilder(imported, log.report).build();
}

}  // namespace vox
