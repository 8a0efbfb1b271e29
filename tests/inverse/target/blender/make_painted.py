"""Paints colour attributes in Blender 3.4 and exports them: painted.glb beside this file.

blender -b --factory-startup --python make_painted.py

Colours are a function of the place, in glTF's coordinates: R = (x + 2) / 4, G = (y + 2) / 4, B = (z + 2) / 4, with R three
times that where they are floats.
"""

from pathlib import Path

import bpy


def paint(mesh, data_type):
    gain = 3 if data_type == "FLOAT_COLOR" else 1
    attribute = mesh.color_attributes.new("Paint", data_type, "POINT")
    for vertex in mesh.vertices:
        x, y, z = vertex.co.x, vertex.co.z, -vertex.co.y
        attribute.data[vertex.index].color = (gain * (x + 2) / 4, (y + 2) / 4, (z + 2) / 4, 1)


def subdivided(cuts):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide(number_cuts=cuts)
    bpy.ops.object.mode_set(mode="OBJECT")
    return bpy.context.object


def add(name, primitive, cuts, **options):
    primitive(**options)
    shown = subdivided(cuts)
    shown.name = shown.data.name = name
    return shown


bpy.ops.wm.read_factory_settings(use_empty=True)
ground = add("floats", bpy.ops.mesh.primitive_plane_add, 5, size=4)
paint(ground.data, "FLOAT_COLOR")
cube = add("bytes", bpy.ops.mesh.primitive_cube_add, 1, size=2)
paint(cube.data, "BYTE_COLOR")
copy = bpy.data.objects.new("copy", cube.data)
copy.location = (10, 0, 0)
copy.scale = (-1, 1, 1)
bpy.context.scene.collection.objects.link(copy)
add("unpainted", bpy.ops.mesh.primitive_plane_add, 0, size=1, location=(0, 0, 3))
bpy.ops.export_scene.gltf(filepath=str(Path(__file__).with_name("painted.glb")), export_format="GLB", export_colors=True)
