// Meshes from NumPy's arrays, and arrays that show meshes.

#include "apps/python/mesh_arrays.h"

#include "libvox/core/color.h"
#include "libvox/core/error.h"
#include "libvox/io/read_mesh.h"
#include "libvox/mesh/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace vox::python {
namespace {

namespace py = pybind11;

std::string str(std::int64_t number) {
  return std::to_string(number);
}

/// Refuses counts of which numbers do not fit into an Index.
std::size_t countOf(const char* name, const py::array& array) {
  const auto count = static_cast<std::size_t>(array.shape(0));
  if (count >= kNone) throw LimitError(std::string(name) + ": has 2^32 - 1 elements or more");
  return count;
}

/// @param columns  1: an array of one dimension
void requireShape(const char* name, const py::array& array, py::ssize_t columns) {
  const bool isFlat = columns == 1;
  const bool fits = isFlat ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == columns;
  if (!fits || (array.flags() & py::array::c_style) == 0)
    throw InputError(std::string(name) + ": has a wrong shape");
}

template <class Number>
bool holds(const py::array& array) {
  return py::isinstance<py::array_t<Number>>(array);
}

/// Calls work(data) with a pointer to the numbers of one of the types.
template <class... Numbers, class Work>
void withNumbers(const char* name, const py::array& array, Work&& work) {
  const bool isKnown =
      ((holds<Numbers>(array) ? (work(static_cast<const Numbers*>(array.data())), true) : false) ||
       ...);
  if (!isKnown) throw InputError(std::string(name) + ": has numbers of a wrong type");
}

/// Copies indices below a limit.
/// @return  how many are good before the first that is not
template <class Number>
std::size_t copyIndices(const Number* numbers, std::size_t limit, std::vector<Index>& indices) {
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Number number = numbers[i];  // read once: another thread may change the array
    if (std::cmp_less(number, 0) || std::cmp_greater_equal(number, limit)) return i;
    indices[i] = static_cast<Index>(number);
  }
  return indices.size();
}

/// @param limit   indices must be lower
/// @param refuse  called with the place and the text of the first index that is not
template <class Refuse>
std::vector<Index> copiedIndices(const char* name, const py::array& array, std::size_t limit,
                                 Refuse&& refuse) {
  std::vector<Index> indices(static_cast<std::size_t>(array.size()));
  withNumbers<std::int32_t, std::uint32_t, std::int64_t, std::uint64_t>(
      name, array, [&](const auto* numbers) {
        const std::size_t good = copyIndices(numbers, limit, indices);
        if (good < indices.size()) refuse(good, std::to_string(numbers[good]));
      });
  return indices;
}

std::vector<Vec3d> pointsOf(const py::array& array) {
  requireShape("points", array, 3);
  std::vector<Vec3d> points(countOf("points", array));
  withNumbers<float, double>("points", array, [&](const auto* numbers) {
    for (std::size_t v = 0; v < points.size(); ++v)
      points[v] = Vec3d(numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]);
  });
  return points;
}

void requireInRange(const std::vector<Vec3d>& points) {
  const auto wrong = std::find_if(points.begin(), points.end(), [](const Vec3d& point) {
    return !(point.cwiseAbs().maxCoeff() <= kMaxCoordinate);
  });
  if (wrong != points.end())
    throw MeshError("vertex " + str(wrong - points.begin()) +
                    (wrong->allFinite() ? " has a coordinate beyond 1e15"
                                        : " has a coordinate that is not finite"));
}

void copyFaces(const MeshArrays& arrays, PolygonMesh& mesh) {
  requireShape("faces", arrays.faceOffsets, 1);
  requireShape("faces", arrays.faceVertices, 1);
  countOf("faces", arrays.faceOffsets);
  const std::size_t corners = countOf("corners", arrays.faceVertices);
  if (arrays.faceOffsets.size() < 2) throw MeshError("the mesh has no faces");
  mesh.faceOffsets = copiedIndices(
      "offsets", arrays.faceOffsets, corners + 1, [&](std::size_t place, const std::string& is) {
        throw MeshError("offset " + str(static_cast<std::int64_t>(place)) + " is " + is + " of " +
                        str(static_cast<std::int64_t>(corners)) + " corners");
      });
  if (mesh.faceOffsets.front() != 0 || mesh.faceOffsets.back() != corners)
    throw MeshError("offsets must start at 0 and end at the number of corners, " +
                    str(static_cast<std::int64_t>(corners)));
  mesh.faceVertices =
      copiedIndices("corners", arrays.faceVertices, mesh.points.size(),
                    [&](std::size_t corner, const std::string& is) {
                      const auto after = std::upper_bound(mesh.faceOffsets.begin(),
                                                          mesh.faceOffsets.end(), corner);
                      throw MeshError("face " + str(after - mesh.faceOffsets.begin() - 1) +
                                      " names vertex " + is + " of " + str(mesh.pointCount()));
                    });
}

/// 0 to 255 on a screen as linear light.
std::array<float, 256> screenTable() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(linearFromScreen(static_cast<double>(i) / 255));
  return table;
}

float lightOf(std::uint8_t value) {
  static const std::array<float, 256> table = screenTable();
  return table[value];
}
float lightOf(float value) {
  return value;
}
float lightOf(double value) {
  return static_cast<float>(value);
}

void requireCount(const char* name, const py::array& array, std::size_t count, const char* each) {
  if (static_cast<std::size_t>(array.shape(0)) != count)
    throw InputError(std::string(name) + ": must have one row per " + each + ": " +
                     str(static_cast<std::int64_t>(count)) + ", not " + str(array.shape(0)));
}

std::vector<Vec3f> colorsOf(const char* name, const std::optional<py::array>& array,
                            std::size_t count, const char* each) {
  if (!array) return {};
  requireShape(name, *array, 3);
  requireCount(name, *array, count, each);
  std::vector<Vec3f> colors(count);
  withNumbers<std::uint8_t, float, double>(name, *array, [&](const auto* numbers) {
    for (std::size_t i = 0; i < count; ++i)
      colors[i] =
          Vec3f(lightOf(numbers[3 * i]), lightOf(numbers[3 * i + 1]), lightOf(numbers[3 * i + 2]));
  });
  const auto wrong = std::find_if(colors.begin(), colors.end(), [](const Vec3f& color) {
    return !(color.minCoeff() >= 0 && color.maxCoeff() <= 1) || !color.allFinite();
  });
  if (wrong != colors.end())
    throw InputError(std::string(name) + ": row " + str(wrong - colors.begin()) +
                     ": floats must lie between 0 and 1");
  return colors;
}

std::vector<Vec2f> texcoordsOf(const std::optional<py::array>& array, std::size_t corners) {
  if (!array) return {};
  requireShape("uv", *array, 2);
  requireCount("uv", *array, corners, "corner");
  std::vector<Vec2f> texcoords(corners);
  withNumbers<float, double>("uv", *array, [&](const auto* numbers) {
    for (std::size_t c = 0; c < corners; ++c)
      texcoords[c] =
          Vec2f(static_cast<float>(numbers[2 * c]), static_cast<float>(numbers[2 * c + 1]));
  });
  for (std::size_t c = 0; c < corners; ++c)
    if (texcoords[c].array().isInf().any())
      throw InputError("uv: row " + str(static_cast<std::int64_t>(c)) + " is infinite");
  return texcoords;
}

/// Whole numbers of 32 bits, one for each face.
std::vector<Index> ofFaces(const char* name, const py::array& array, std::size_t faces) {
  requireShape(name, array, 1);
  requireCount(name, array, faces, "face");
  return indicesOf(name, array);
}

FaceSets setsOf(const char* name, const std::optional<Sets>& sets, std::size_t faces) {
  if (!sets) return {};
  const auto& [names, numbers] = *sets;
  requireShape(name, numbers, 1);
  requireCount(name, numbers, faces, "face");
  if (!holds<std::int64_t>(numbers))
    throw InputError(std::string(name) + ": has numbers of a wrong type");
  FaceSets all{names, std::vector<Index>(faces, kNone)};
  const auto* const data = static_cast<const std::int64_t*>(numbers.data());
  for (std::size_t f = 0; f < faces; ++f) {
    const std::int64_t number = data[f];
    if (number < 0) continue;
    if (std::cmp_greater_equal(number, names.size()))
      throw InputError(std::string(name) + ": face " + str(static_cast<std::int64_t>(f)) +
                       " has number " + str(number) + " of " +
                       str(static_cast<std::int64_t>(names.size())) + " names");
    all.ofFaces[f] = static_cast<Index>(number);
  }
  return all;
}

/// An array on memory that a scene owns.
template <class Number>
py::array viewOf(const SharedScene& owner, const Number* data, std::vector<py::ssize_t> shape) {
  const py::capsule keeper(new SharedScene(owner),
                           [](void* scene) { delete static_cast<SharedScene*>(scene); });
  py::array_t<Number> array(std::move(shape), data, keeper);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class Vector>
py::array rowsOf(const SharedScene& owner, const std::vector<Vector>& rows) {
  using Number = typename Vector::Scalar;
  constexpr std::size_t kColumns = Vector::RowsAtCompileTime;
  static_assert(sizeof(Vector) == kColumns * sizeof(Number));
  return viewOf(owner, reinterpret_cast<const Number*>(rows.data()),
                {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(kColumns)});
}

}  // namespace

PolygonMesh meshOf(const MeshArrays& arrays) {
  PolygonMesh mesh;
  mesh.points = pointsOf(arrays.points);
  requireInRange(mesh.points);
  copyFaces(arrays, mesh);
  const std::size_t faces = mesh.faceCount();
  mesh.pointColors = colorsOf("point_colors", arrays.pointColors, mesh.pointCount(), "vertex");
  mesh.faceColors = colorsOf("face_colors", arrays.faceColors, faces, "face");
  mesh.attributes.texcoords = texcoordsOf(arrays.texcoords, mesh.cornerCount());
  if (arrays.faceGroups) mesh.faceGroups = ofFaces("smoothing_groups", *arrays.faceGroups, faces);
  mesh.attributes.objects = setsOf("objects", arrays.objects, faces);
  mesh.attributes.groups = setsOf("groups", arrays.groups, faces);
  mesh.attributes.materials = setsOf("materials", arrays.materials, faces);
  requireValidArrays(mesh);
  return mesh;
}

std::vector<Index> indicesOf(const char* name, const py::array& array) {
  return copiedIndices(name, array, kNone, [&](std::size_t place, const std::string& is) {
    throw InputError(std::string(name) + ": number " + str(static_cast<std::int64_t>(place)) +
                     " is " + is + "; it must lie between 0 and 2^32 - 2");
  });
}

py::array view(const SharedScene& owner, const std::vector<Vec3d>& rows) {
  return rowsOf(owner, rows);
}

py::object viewOrNone(const SharedScene& owner, const std::vector<Vec3f>& rows) {
  if (rows.empty()) return py::none();
  return rowsOf(owner, rows);
}

py::object viewOrNone(const SharedScene& owner, const std::vector<Vec2f>& rows) {
  if (rows.empty()) return py::none();
  return rowsOf(owner, rows);
}

py::array view(const SharedScene& owner, const std::vector<Index>& numbers) {
  return viewOf(owner, numbers.data(), {static_cast<py::ssize_t>(numbers.size())});
}

py::object viewOrNone(const SharedScene& owner, const std::vector<Index>& numbers) {
  if (numbers.empty()) return py::none();
  return view(owner, numbers);
}

}  // namespace vox::python
