"""A camera and a sun for a model, in an untouched scene."""

import bpy
from mathutils import Vector

LIGHT = Vector((-0.5, -0.6, 0.62))  # towards the sun, in world space
TOWARDS_CAMERA = Vector((0.35, -0.85, 0.35))  # from the front, a bit above and to the right
LENS = 100  # millimetres; a long lens fits the model closer than Blender's 50


def frame(volume):
    """Points the camera at the middle of the volume, with a sun, both made if there are none."""
    scene = bpy.context.scene
    corners = [volume.matrix_world @ Vector(corner) for corner in volume.bound_box]
    middle = sum(corners, Vector()) / len(corners)
    if scene.camera is None:
        scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        scene.collection.objects.link(scene.camera)
    camera = scene.camera
    camera.data.lens = LENS
    turn = (-TOWARDS_CAMERA).to_track_quat("-Z", "Y")
    # The slopes of the sides of the picture, in the space of the camera, which looks along -z.
    edge = camera.data.view_frame(scene=scene)[0]
    slopes = abs(edge.x / edge.z), abs(edge.y / edge.z)
    far = 0
    for corner in corners:
        seen = turn.inverted() @ (corner - middle)
        far = max(far, seen.z + abs(seen.x) / slopes[0], seen.z + abs(seen.y) / slopes[1])
    camera.rotation_euler = turn.to_euler()
    camera.location = middle + turn @ Vector((0, 0, far))
    distance = max((corner - camera.location).length for corner in corners)
    camera.data.clip_start = distance / 10000
    camera.data.clip_end = distance * 10
    if not any(o.type == "LIGHT" and o.data.type == "SUN" for o in scene.objects):
        sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy = 5
        sun.rotation_euler = (-LIGHT).to_track_quat("-Z", "Y").to_euler()
        scene.collection.objects.link(sun)


def make_way():
    """Removes the cube of an untouched startup scene, which would hide the model."""
    cube = bpy.data.objects.get("Cube")
    if not bpy.data.filepath and cube is not None and len(cube.data.vertices) == 8:
        bpy.data.objects.remove(cube)
