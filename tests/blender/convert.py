"""The operator Convert makes the voxels that the command line makes of the same mesh."""

import os

import bpy
from mathutils import Matrix, Vector
from meshes import empty_scene, faces_of, moved, same, suzanne, vox, write_obj

TARGET = "--target", "blender-3.4" if bpy.app.version < (3, 5) else "blender"


def srgb(linear):
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def bounds(thing):
    corners = [thing.matrix_world @ Vector(corner) for corner in thing.bound_box]
    return [(min(c[i] for c in corners), max(c[i] for c in corners)) for i in range(3)]


def covers(volume, mesh):
    """Whether a volume lies over its mesh. Blender rounds its box up to whole leaves of 8 voxels."""
    bpy.context.view_layer.update()
    slack = 17 * max(volume.data.grids[0].matrix_object.to_scale()) * max(mesh.matrix_world.to_scale())
    return all(
        a - slack < b and c < d + slack for (b, d), (a, c) in zip(bounds(mesh), bounds(volume))
    ) and all(a < (b + d) / 2 < c for (b, d), (a, c) in zip(bounds(mesh), bounds(volume)))


# Creases, sharp edges, corners and a colour attribute, of a mesh that is turned and scaled evenly.
empty_scene()
thing = suzanne()
thing.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(0.5, 4, "X") @ Matrix.Scale(2, 4)
mesh = thing.data
creased, sharp, soft_crease = 10, 200, 300
mesh.edges[creased].crease = 1
mesh.edges[soft_crease].crease = 0.4  # less than half: smooth
mesh.edges[sharp].use_edge_sharp = True
colors = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
for i, vertex in enumerate(mesh.vertices):
    colors.data[i].color = (i / len(mesh.vertices), 0.5, abs(vertex.co.x) % 1, 1)
thing.vox.grids = {"density", "mask", "color", "normal"}
thing.vox.color = "ATTRIBUTE"
assert bpy.ops.object.vox_convert() == {"FINISHED"}
write_obj("a.obj", [v.co for v in mesh.vertices], faces_of(mesh), [[srgb(x) for x in c.color[:3]] for c in colors.data])
with open("edges.txt", "w") as file:
    for edge in creased, sharp:
        file.write("{} {}\n".format(*mesh.edges[edge].vertices))
grids = "--grids", "density,mask,normal,color", "--dim", "80"
vox("convert", "a.obj", "-o", "a.vdb", *TARGET, *grids, "--crease-edges", "edges.txt")
assert same("Suzanne.vdb", "a.vdb")
volume = bpy.context.object
assert volume.type == "VOLUME" and volume.vox.mesh == thing and thing.hide_get() and not volume.hide_get()
assert volume.users_collection == thing.users_collection
assert (volume.matrix_world.translation - thing.matrix_world.translation).length < 1e-6
thing.hide_set(False)
assert covers(volume, thing)

# Again, with other settings: the same volume and material, and what the user did to it stays.
material = volume.active_material
shader = next(node for node in material.node_tree.nodes if node.type == "PRINCIPLED_VOLUME")
shader.inputs["Anisotropy"].default_value = 0.25
depth = material.node_tree.nodes["Vox Depth"].inputs[1].default_value
thing.vox.use_creases = thing.vox.use_sharp = False
thing.vox.dim = 40
assert bpy.ops.object.vox_convert() == {"FINISHED"}  # the active object is the volume
assert [o for o in bpy.data.objects if o.type == "VOLUME"] == [volume] and volume.active_material == material
assert shader.inputs["Anisotropy"].default_value == 0.25
assert abs(material.node_tree.nodes["Vox Depth"].inputs[1].default_value * 2 / depth - 1) < 1e-3
voxel = volume.data.grids[0].matrix_object.to_scale()[0]
assert abs(voxel - 2.734375 / 40) < 1e-4, voxel  # Suzanne is 2.734375 wide
evaluated = volume.evaluated_get(bpy.context.evaluated_depsgraph_get())  # what is drawn
assert evaluated.data.grids[0].matrix_object.to_scale()[0] == voxel
vox("convert", "a.obj", "-o", "again.vdb", *TARGET, *grids[:3], "40")
assert same("Suzanne.vdb", "again.vdb")

# Corners, an uneven scale, modifiers with n-gons, and a voxel size in units of the world.
empty_scene()
bpy.ops.mesh.primitive_cylinder_add(vertices=7)
thing = bpy.context.object
thing.name = "Seven sides/1"
thing.matrix_world = Matrix.Translation((-4, 0, 1)) @ Matrix.Diagonal((1, 2, 0.5, 1))
thing.vox.folder, thing.vox.resolution, thing.vox.voxel_size = os.getcwd(), "SIZE", 0.05
array = thing.modifiers.new("Array", "ARRAY")
array.use_constant_offset, array.use_relative_offset, array.constant_offset_displace = True, False, (3, 0, 0)
mesh = thing.data
import bmesh

edit = bmesh.new()
edit.from_mesh(mesh)
creases = edit.verts.layers.crease.verify()
edit.verts.ensure_lookup_table()
edit.verts[3][creases] = 1
edit.to_mesh(mesh)
thing.vox.grids = {"density", "surface"}
thing.vox.use_soft, thing.vox.use_solid, thing.vox.interpolate = False, True, "interior"
thing.vox.use_angle, thing.vox.angle = True, 1.2
thing.vox.more = "--band '2,4'"
assert bpy.ops.object.vox_convert() == {"FINISHED"}
size = len(mesh.vertices)
points = [moved(thing.matrix_world, v.co + Vector((3 * copy, 0, 0))) for copy in (0, 1) for v in mesh.vertices]
faces = faces_of(mesh)
write_obj("b.obj", points, faces + [[v + size for v in face] for face in faces])
with open("corners.txt", "w") as file:
    file.write(f"3 {3 + size}\n")
vox("convert", "b.obj", "-o", "b.vdb", *TARGET, "--grids", "density,surface", "--voxel-size", "0.05",
    "--edge", "hard", "--fill", "solid", "--interpolate", "interior", "--crease", "68.7549",
    "--corner-vertices", "corners.txt", "--band", "2,4")
made = "Seven_sides_1.vdb"
assert same(made, "b.vdb")
volume = bpy.context.object
assert volume.matrix_world == Matrix.Identity(4)
assert thing.hide_get()  # and yet it has its modifiers when it is converted again
os.remove(made)
assert bpy.ops.object.vox_convert() == {"FINISHED"} and bpy.context.object == volume
assert same(made, "b.vdb") and thing.hide_get()

# A mirrored open mesh: its normals point to the side to which Blender's do.
empty_scene()
bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=2)
thing = bpy.context.object
thing.matrix_world = Matrix.Diagonal((-1, 2, 1, 1))
thing.vox.folder, thing.vox.dim, thing.vox.grids = os.getcwd(), 40, {"density", "normal"}
assert bpy.ops.object.vox_convert() == {"FINISHED"}
points = [moved(thing.matrix_world, v.co) for v in thing.data.vertices]
write_obj("m.obj", points, [face[::-1] for face in faces_of(thing.data)])
vox("convert", "m.obj", "-o", "m.vdb", *TARGET, "--grids", "density,normal", "--dim", "40")
assert same("Grid.vdb", "m.vdb")

# Materials: plain colours, an image that a node Mapping places, and the parts of the grid part.
empty_scene()
bpy.ops.mesh.primitive_cube_add()
thing = bpy.context.object
thing.name = "Box"
thing.vox.folder, thing.vox.dim, thing.vox.grids = os.getcwd(), 60, {"density", "color", "part"}
thing.vox.use_soft = False
image = bpy.data.images.new("board", 8, 8)
image.pixels = [x for i in range(64) for x in (i / 64, 0.3, (i % 8) / 8, 1)]
image.pack()
mesh = thing.data
for name, color in ("Red", (0.8, 0.05, 0.1, 1)), ("Painted", None), ("Viewport", (0.1, 0.2, 0.7, 1)):
    material = bpy.data.materials.new(name)
    mesh.materials.append(material)
    material.use_nodes = name != "Viewport"
    if name == "Red":
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    elif color:
        material.diffuse_color = color
    else:
        nodes, links = material.node_tree.nodes, material.node_tree.links
        texture, mapping = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeMapping")
        coordinates = nodes.new("ShaderNodeTexCoord")
        texture.image = image
        texture.extension = "EXTEND"
        mapping.inputs["Location"].default_value = (0.25, 0.5, 0)
        mapping.inputs["Scale"].default_value = (3, 2, 1)
        links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        links.new(mapping.outputs[0], texture.inputs["Vector"])
        links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
for i, polygon in enumerate(mesh.polygons):
    polygon.material_index = i % 3
assert bpy.ops.object.vox_convert() == {"FINISHED"}
image.filepath_raw, image.file_format = os.path.abspath("board.png"), "PNG"
image.save()
with open("c.mtl", "w") as file:
    file.write("newmtl Red\nKd 0.8 0.05 0.1\nnewmtl Painted\nmap_Kd -clamp on board.png\n")
    file.write("newmtl Viewport\nKd 0.1 0.2 0.7\n")
lines = ["mtllib c.mtl"]
for i, polygon in enumerate(mesh.polygons):
    lines.append("usemtl " + mesh.materials[i % 3].name)
    for loop in polygon.loop_indices:
        u, v = mesh.uv_layers[0].data[loop].uv
        lines.append(f"vt {3 * u + 0.25!r} {2 * v + 0.5!r}")
    lines.append("f " + " ".join(f"{v + 1}/{loop + 1}" for v, loop in zip(polygon.vertices, polygon.loop_indices)))
write_obj("c.obj", [v.co for v in mesh.vertices], lines)
vox("convert", "c.obj", "-o", "c.vdb", *TARGET, "--grids", "density,color,part", "--part-by", "material",
    "--edge", "hard", "--dim", "60")
assert same("Box.vdb", "c.vdb")

# Colours of face corners: one for each face are kept, others are blended at the vertices.
paint = mesh.color_attributes.new("Corners", "FLOAT_COLOR", "CORNER")
mesh.color_attributes.active_color = paint
for polygon in mesh.polygons:
    for loop in polygon.loop_indices:
        paint.data[loop].color = (polygon.index / 6, 0.5, 0, 1)
thing.vox.grids, thing.vox.color = {"density", "color"}, "ATTRIBUTE"
assert bpy.ops.object.vox_convert() == {"FINISHED"}
with open("d.mtl", "w") as file:
    file.writelines(f"newmtl m{i}\nKd {i / 6!r} 0.5 0\n" for i in range(6))
lines = ["mtllib d.mtl"]
for polygon in mesh.polygons:
    lines += [f"usemtl m{polygon.index}", "f " + " ".join(str(v + 1) for v in polygon.vertices)]
write_obj("d.obj", [v.co for v in mesh.vertices], lines)
vox("convert", "d.obj", "-o", "d.vdb", *TARGET, "--grids", "density,color", "--edge", "hard", "--dim", "60")
assert same("Box.vdb", "d.vdb")
for loop in mesh.loops:
    paint.data[loop.index].color = (loop.index % 2, 0, 0.5, 1)
assert bpy.ops.object.vox_convert() == {"FINISHED"}
means = [[loop.index % 2 for loop in mesh.loops if loop.vertex_index == v.index] for v in mesh.vertices]
colors = [(srgb(sum(each) / len(each)), 0, srgb(0.5)) for each in means]
write_obj("e.obj", [v.co for v in mesh.vertices], faces_of(mesh), colors)
vox("convert", "e.obj", "-o", "e.vdb", *TARGET, "--grids", "density,color", "--edge", "hard", "--dim", "60")
assert same("Box.vdb", "e.vdb")

# File > Export, and polygons as they are.
thing.vox.use_smooth = False
assert bpy.ops.export_scene.vox(filepath=os.path.abspath("export.vdb")) == {"FINISHED"}
polygons = "--grids", "density,color", "--edge", "hard", "--dim", "60", "--until", "levels=0"
vox("convert", "e.obj", "-o", "f.vdb", *polygons)
assert same("export.vdb", "f.vdb")
assert bpy.ops.export_scene.vox(filepath=os.path.abspath("export.nvdb"), target="HOUDINI") == {"FINISHED"}
vox("convert", "e.obj", "-o", "g.nvdb", "--target", "houdini", "--up", "z", *polygons)
assert same("export.nvdb", "g.nvdb")

# File > Import.
assert bpy.ops.import_scene.vox(filepath=os.path.abspath("export.vdb")) == {"FINISHED"}
assert bpy.context.object.type == "VOLUME" and bpy.context.object.active_material.use_nodes
print("as the command line")
