"""The manifest, which Blender 4.2 and later read, says what bl_info says, and keeps Blender's rules."""

import os
import tomllib

import vox_addon

with open(os.path.join(os.path.dirname(vox_addon.__file__), "blender_manifest.toml"), "rb") as file:
    manifest = tomllib.load(file)
info = vox_addon.bl_info
assert manifest["version"] == "{}.{}.{}".format(*info["version"])
for theirs, ours in ("name", "name"), ("tagline", "description"), ("maintainer", "author"):
    assert manifest[theirs] == info[ours], theirs
assert manifest["schema_version"] == "1.0.0" and manifest["id"] == "vox" and manifest["type"] == "add-on"
assert manifest["license"] == ["SPDX:MIT"] and manifest["blender_version_min"] == "4.2.0"
for text in manifest["tagline"], *manifest["permissions"].values():
    assert len(text) <= 64 and text[-1].isalnum(), text
