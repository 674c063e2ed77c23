// Refined meshes with normals, colours and materials.

#include "libvox/pipeline/shaded_refinement.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/io/input_file.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/pipeline/colors.h"
#include "libvox/pipeline/corner_blend.h"
#include "libvox/pipeline/object_look.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/limit_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace vox {
namespace {

/// A place in the square of a corner of the base.
struct BasePlace {
  Index corner;
  Vec2f at;
};

/// The materials of a scene, and the contents of their images, each of them once.
class SceneMaterials {
 public:
  SceneMaterials(std::vector<Material>& all, ImageReader& images) : all_(all), images_(images) {}

  std::size_t add(Material material) {
    if (material.image) complete(*material.image);
    all_.push_back(std::move(material));
    return all_.size() - 1;
  }

 private:
  /// Gives an image its content. An image without transparent pixels is opaque.
  void complete(ImageMap& map) {
    const std::shared_ptr<const Image> image = images_.read(map);
    map.opaque = map.opaque || std::all_of(image->pixels.begin(), image->pixels.end(),
                                           [](const Pixel& pixel) { return pixel[3] == 255; });
    if (map.content) return;
    std::shared_ptr<const std::string>& content = contents_[map.file];
    if (!content)
      content = std::make_shared<const std::string>(std::string_view(contentsOf(map.file)));
    map.content = content;
  }

  std::vector<Material>& all_;
  ImageReader& images_;
  std::map<std::string, std::shared_ptr<const std::string>> contents_;
};

/// What the faces of the base of an object look like, in kinds.
class BaseLook {
 public:
  BaseLook(const SceneObject& object, SubdivisionLevel base, SurfaceLook look,
           std::optional<PlacedTexture> texture)
      : object_(object),
        base_(std::move(base)),
        look_(std::move(look)),
        texture_(std::move(texture)),
        cornerColors_(colorsOfCorners(base_.mesh)) {
    const PolygonMesh& mesh = base_.mesh;
    if (!cornerColors_.empty())
      meanColors_ = meansOfFaces<Vec3f>(mesh, [&](Index c) { return cornerColors_[c]; });
    if (!look_.texcoords.empty())
      meanTexcoords_ = meansOfFaces<Vec2f>(mesh, [&](Index c) { return look_.texcoords[c]; });
    const bool replaces = look_.lookOfFace.empty() && !look_.looks.empty();
    if (!replaces) return;
    textureImage_.emplace();
    textureImage_->file = object.texture->file;
    textureImage_->clamp = object.texture->clamp;
  }

  const SubdivisionLevel& base() const { return base_; }
  Index faceOf(Index corner) const { return base_.adjacency.cornerFace[corner]; }

  /// Kinds of faces are told by their materials, and by whether they have texture coordinates.
  Index kindCount() const { return 2 * static_cast<Index>(look_.looks.size() + 1); }
  Index kindOf(Index face) const {
    const Index look = look_.lookOfFace.empty() ? 0 : look_.lookOfFace[face];
    const bool isPlain = look_.looks.empty() || look == kNone;
    return 2 * (isPlain ? 0 : look + 1) + (hasTexcoords(face) ? 1 : 0);
  }
  static bool hasTexcoordsOf(Index kind) { return kind % 2 == 1; }

  /// Whether vertices of a kind have colours: all other colours are those of the material.
  bool hasColorsOf(Index kind) const {
    if (texture_) return true;
    return !cornerColors_.empty() &&
           (lookOf(kind) == nullptr || lookOf(kind)->multiplies || imageOf(kind) == nullptr);
  }

  /// True if corners at one vertex of the base may differ.
  bool differsByCorner() const {
    return !look_.texcoords.empty() || base_.mesh.pointColors.empty();
  }

  Material materialOf(Index kind) const {
    Material material;
    material.name = object_.name;
    const Look* const look = lookOf(kind);
    const ImageMap* const image = imageOf(kind);
    if (look == nullptr) {
      if (hasColorsOf(kind)) material.color.setOnes();
      return material;
    }
    if (!textureImage_) material.name = object_.mesh.attributes.looks[kind / 2 - 1].name;
    const bool isWhite = !look->multiplies && (image != nullptr || hasColorsOf(kind));
    material.color = isWhite ? Vec3f(Vec3f::Ones()) : Vec3f(look->color.head<3>());
    material.opacity = static_cast<double>(look->color[3]);
    if (image != nullptr) material.image = *image;
    return material;
  }

  Vec2f texcoordAt(const BasePlace& place) const {
    return blendOf(base_, place.corner, meanTexcoords_[faceOf(place.corner)],
                   [&](Index c) { return look_.texcoords[c]; })
        .at(static_cast<double>(place.at[0]), static_cast<double>(place.at[1]));
  }

  Vec3f colorAt(const BasePlace& place, const Vec3d& world) const {
    if (texture_) return texture_->texture.colorAt(texture_->fromWorld * world).cast<float>();
    return blendOf(base_, place.corner, meanColors_[faceOf(place.corner)],
                   [&](Index c) { return cornerColors_[c]; })
        .at(static_cast<double>(place.at[0]), static_cast<double>(place.at[1]));
  }

 private:
  bool hasTexcoords(Index face) const {
    return !meanTexcoords_.empty() && meanTexcoords_[face].allFinite();
  }
  const Look* lookOf(Index kind) const { return kind < 2 ? nullptr : &look_.looks[kind / 2 - 1]; }
  /// The image of a kind, if it can be read and laid on; else null.
  const ImageMap* imageOf(Index kind) const {
    if (!hasTexcoordsOf(kind) || lookOf(kind) == nullptr || !lookOf(kind)->image) return nullptr;
    return textureImage_ ? &*textureImage_ : &*object_.mesh.attributes.looks[kind / 2 - 1].image;
  }

  const SceneObject& object_;
  SubdivisionLevel base_;
  SurfaceLook look_;
  std::optional<PlacedTexture> texture_;
  std::vector<Vec3f> cornerColors_;
  std::vector<Vec3f> meanColors_;
  std::vector<Vec2f> meanTexcoords_;
  std::optional<ImageMap> textureImage_;  // in place of all materials
};

/// The faces of a refined mesh on the base: of which kind each is, and where its corners lie.
class FacesOnBase {
 public:
  FacesOnBase(const BaseLook& look, const SubdivisionLevel& level, std::vector<VertexPlace> places,
              int levels)
      : look_(look),
        level_(level),
        places_(std::move(places)),
        step_(static_cast<float>(std::ldexp(1.0, -levels))) {
    if (!places_.empty()) turns_ = cornerTurns(level, places_);
  }

  /// The place of a corner, whatever its face.
  BasePlace ownPlace(Index c) const {
    if (places_.empty()) return {c, Vec2f::Zero()};
    const VertexPlace& place = places_[level_.mesh.faceVertices[c]];
    return {place.corner, {place.u, place.v}};
  }

  /// Which corners of a face lie beyond a seam: a seam parts them from the corner on the lowest
  /// face of the base, to which the face belongs. Empty if no seam crosses the face.
  std::vector<bool> beyondSeam(Index f) const {
    const Index begin = level_.mesh.faceOffsets[f];
    const Index n = level_.mesh.faceSize(f);
    std::vector<bool> beyond;
    if (isOnOneFace(f)) return beyond;
    std::vector<bool> seams(n);  // after each corner
    for (Index i = 0; i < n; ++i) seams[i] = isSeam(begin + i, begin + (i + 1) % n);
    if (std::none_of(seams.begin(), seams.end(), [](bool seam) { return seam; })) return beyond;
    const Index home = homeCorner(f) - begin;
    beyond.assign(n, true);
    beyond[home] = false;
    for (Index i = home; !seams[i] && beyond[(i + 1) % n]; i = (i + 1) % n)
      beyond[(i + 1) % n] = false;
    for (Index i = home; !seams[(i + n - 1) % n] && beyond[(i + n - 1) % n]; i = (i + n - 1) % n)
      beyond[(i + n - 1) % n] = false;
    return beyond;
  }

  Index kindOf(Index f) const { return look_.kindOf(baseFace(homeCorner(f))); }

  /// The place at the seam nearest to a corner beyond it.
  /// @param i       number of the corner in the face
  /// @param beyond  of the face
  BasePlace placeAtSeam(Index f, Index i, const std::vector<bool>& beyond) const {
    const Index begin = level_.mesh.faceOffsets[f];
    const Index n = level_.mesh.faceSize(f);
    const Index before = (i + n - 1) % n;
    const Index after = (i + 1) % n;
    if (!beyond[before]) return moved(begin + before, turnedAxis(turns_[begin + before]));
    if (!beyond[after]) return moved(begin + after, turnedAxis(turns_[begin + after] + 1U));
    const auto inside = std::find(beyond.begin(), beyond.end(), false) - beyond.begin();
    const Index c = begin + static_cast<Index>(inside);
    return moved(c, turnedAxis(turns_[c]) + turnedAxis(turns_[c] + 1U));
  }

 private:
  Index baseFace(Index c) const { return look_.faceOf(ownPlace(c).corner); }

  /// The first corner on the lowest face of the base.
  Index homeCorner(Index f) const {
    Index home = level_.mesh.faceOffsets[f];
    for (Index c = home; c < level_.mesh.faceOffsets[f + 1]; ++c)
      if (baseFace(c) < baseFace(home)) home = c;
    return home;
  }

  bool isOnOneFace(Index f) const {
    const Index first = level_.mesh.faceOffsets[f];
    for (Index c = first; c < level_.mesh.faceOffsets[f + 1]; ++c)
      if (baseFace(c) != baseFace(first)) return false;
    return true;
  }

  BasePlace moved(Index c, const Vec2f& axis) const {
    BasePlace place = ownPlace(c);
    place.at = (place.at + step_ * axis).cwiseMax(0).cwiseMin(1);
    return place;
  }

  /// Whether a seam crosses the edge between two corners, the first of which leads to the second.
  bool isSeam(Index c, Index next) const {
    const Index here = baseFace(c);
    const Index there = baseFace(next);
    if (here == there) return false;
    const Index kind = look_.kindOf(here);
    if (kind != look_.kindOf(there)) return true;
    if (!BaseLook::hasTexcoordsOf(kind)) return false;
    const Vec2f a = look_.texcoordAt(moved(c, turnedAxis(turns_[c])));
    const Vec2f b = look_.texcoordAt(moved(next, turnedAxis(turns_[next] + 1U)));
    constexpr float kRounding = 1e-5F;
    return (a - b).cwiseAbs().maxCoeff() > kRounding * std::max(1.0F, a.cwiseAbs().maxCoeff());
  }

  const BaseLook& look_;
  const SubdivisionLevel& level_;
  std::vector<VertexPlace> places_;
  float step_;
  std::vector<std::uint8_t> turns_;
};

/// The middle of an object far from the origin, where floats are coarse; else 0.
Vec3d originOf(const PolygonMesh& mesh) {
  constexpr double kFar = 16;  // sizes of the object
  Box box;
  for (const Vec3d& point : mesh.points) box.add(point);
  const Vec3d middle = (box.low + box.high) / 2;
  if (box.empty() || middle.cwiseAbs().maxCoeff() <= kFar * box.longestSide()) return Vec3d::Zero();
  return middle.cast<float>().cast<double>();
}

/// Makes the parts of an object: one for each kind of faces.
class PartMaker {
 public:
  PartMaker(const BaseLook& look, const SubdivisionLevel& level, const FacesOnBase& faces,
            const Vec3d& origin)
      : look_(look),
        level_(level),
        faces_(faces),
        origin_(origin),
        normals_(limitNormals(level)),
        vertexOf_(level.mesh.pointCount(), kNone) {}

  /// @param some  faces of the kind
  ShadedPart make(Index kind, std::span<const Index> some) {
    ShadedPart part;
    kind_ = kind;
    for (const Index f : some) addFace(f, part);
    for (const Index f : some)
      for (const Index v : level_.mesh.face(f)) vertexOf_[v] = kNone;
    return part;
  }

 private:
  void addFace(Index f, ShadedPart& part) {
    const PolygonMesh& mesh = level_.mesh;
    const std::vector<bool> beyond = faces_.beyondSeam(f);
    corners_.clear();
    vertices_.clear();
    for (Index i = 0; i < mesh.faceSize(f); ++i) {
      const Index c = mesh.faceOffsets[f] + i;
      corners_.push_back(mesh.points[mesh.faceVertices[c]]);
      vertices_.push_back(!beyond.empty() && beyond[i]
                              ? addVertex(c, faces_.placeAtSeam(f, i, beyond), part)
                              : vertexAt(c, part));
    }
    triangles_.clear();
    triangulate(corners_, triangles_, unused_);
    for (const auto& [a, b, c] : triangles_) {
      const auto same = [&](Index i, Index j) {
        return part.positions[vertices_[i]] == part.positions[vertices_[j]];
      };
      if (same(a, b) || same(b, c) || same(c, a)) continue;  // where creases meet
      part.triangles.push_back({vertices_[a], vertices_[b], vertices_[c]});
    }
  }

  Index vertexAt(Index c, ShadedPart& part) {
    const Index point = level_.mesh.faceVertices[c];
    // Level 0 has no places: what differs by corner has a vertex for each.
    if (&level_ == &look_.base() && look_.differsByCorner())
      return addVertex(c, faces_.ownPlace(c), part);
    if (vertexOf_[point] == kNone) vertexOf_[point] = addVertex(c, faces_.ownPlace(c), part);
    return vertexOf_[point];
  }

  Index addVertex(Index c, const BasePlace& place, ShadedPart& part) {
    const Index point = level_.mesh.faceVertices[c];
    const Vec3d& world = level_.mesh.points[point];
    part.positions.emplace_back((world - origin_).cast<float>());
    part.normals.emplace_back(normals_[point].cast<float>());
    if (BaseLook::hasTexcoordsOf(kind_)) part.texcoords.push_back(look_.texcoordAt(place));
    if (look_.hasColorsOf(kind_))
      part.colors.emplace_back(look_.colorAt(faces_.ownPlace(c), world).cwiseMax(0).cwiseMin(1));
    return static_cast<Index>(part.positions.size() - 1);
  }

  const BaseLook& look_;
  const SubdivisionLevel& level_;
  const FacesOnBase& faces_;
  Vec3d origin_;
  std::vector<Vec3d> normals_;
  std::vector<Index> vertexOf_;  // of points that the part has
  Index kind_ = 0;
  std::vector<Vec3d> corners_;
  std::vector<Index> vertices_;
  std::vector<std::array<Index, 3>> triangles_;
  TriangulationReport unused_;
};

/// The faces of each kind.
std::vector<std::vector<Index>> facesByKind(const BaseLook& look, const FacesOnBase& faces,
                                            Index count) {
  std::vector<Index> kinds(count);
  parallelForEach(count, kElementsPerTask, [&](Index f) { kinds[f] = faces.kindOf(f); });
  std::vector<std::vector<Index>> all(look.kindCount());
  for (Index f = 0; f < count; ++f) all[kinds[f]].push_back(f);
  return all;
}

/// Texture coordinates as points of the image.
void layOn(const ImageMap& map, std::vector<Vec2f>& texcoords) {
  for (Vec2f& uv : texcoords)
    uv = (uv.cast<double>().cwiseProduct(map.scale) + map.offset).cast<float>();
}

ShadedObject shadedObject(const BaseLook& look, const SubdivisionLevel& level,
                          std::vector<VertexPlace> places, int levels, SceneMaterials& materials) {
  ShadedObject object;
  object.origin = originOf(level.mesh);
  const FacesOnBase faces(look, level, std::move(places), levels);
  PartMaker maker(look, level, faces, object.origin);
  const std::vector<std::vector<Index>> kinds = facesByKind(look, faces, level.mesh.faceCount());
  for (Index kind = 0; kind < kinds.size(); ++kind) {
    if (kinds[kind].empty()) continue;
    ShadedPart part = maker.make(kind, kinds[kind]);
    if (part.triangles.empty()) continue;
    Material material = look.materialOf(kind);
    if (material.image) {
      layOn(*material.image, part.texcoords);
      material.image->scale.setOnes();
      material.image->offset.setZero();
    }
    part.material = materials.add(std::move(material));
    object.parts.push_back(std::move(part));
  }
  return object;
}

/// What shading takes: normals and the points of one more level, places, and the vertices.
std::uint64_t bytesOfShading(const SubdivisionLevel& level) {
  constexpr std::uint64_t kPerCorner = sizeof(Vec3d) + 1;
  constexpr std::uint64_t kPerPoint = sizeof(Vec3d) + sizeof(VertexPlace) + 2 * sizeof(Index);
  constexpr std::uint64_t kPerVertex = 3 * sizeof(Vec3f) + sizeof(Vec2f);
  constexpr std::uint64_t kPerTriangle = 3 * sizeof(Index);
  return level.mesh.cornerCount() * (kPerCorner + 2 * kPerTriangle) +
         level.mesh.pointCount() * (kPerPoint + 2 * kPerVertex);
}

}  // namespace

ShadedRefinement shadedRefinement(const Scene& scene, int levels,
                                  const PreparationOptions& preparation, const RunOptions& run) {
  ShadedRefinement all;
  MemoryBudget imageBudget(run.maxMemory);
  ImageReader images(imageBudget);
  SceneMaterials materials(all.scene.materials, images);
  const auto add = [&](std::size_t i, PreparedObject prepared, MemoryBudget& budget,
                       Progress& progress) {
    const SceneObject& object = scene.objects[i];
    all.warnings.insert(all.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
    std::optional<PlacedTexture> texture = placedTexture(object.texture, object, Turn::kNoTurn);
    SurfaceLook look;
    if (!texture)
      look = lookOf(object, object.texture, prepared.faceOrigin, std::move(prepared.texcoords),
                    images, all.warnings);
    budget.take(bytesOf(prepared.base), "the control mesh", kRefineAdvice);
    const BaseLook baseLook(object, std::move(prepared.base), std::move(look), std::move(texture));
    std::vector<VertexPlace> places;
    SubdivisionLevel refined;
    if (levels > 0)
      refined =
          subdividedWithin(budget, baseLook.base(), levels, progress, Colors::kDropped, &places);
    const SubdivisionLevel& level = levels > 0 ? refined : baseLook.base();
    progress.check();
    budget.take(bytesOfShading(level), "the refined mesh", kRefineAdvice);
    ShadedObject shaded = shadedObject(baseLook, level, std::move(places), levels, materials);
    shaded.name = object.name;
    for (const ShadedPart& part : shaded.parts) {
      all.vertexCount += part.positions.size();
      all.triangleCount += part.triangles.size();
    }
    all.scene.objects.push_back(std::move(shaded));
  };
  prepareEach(scene, levels, preparation, run, true, add);
  if (all.triangleCount == 0) throw MeshError("no triangle of the refined mesh has an area");
  return all;
}

}  // namespace vox
