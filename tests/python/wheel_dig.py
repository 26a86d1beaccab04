# SPDX-License-Identifier: Apache-2.0
"""Digs a full bucket with an installed wheel; run by `./dev python --wheel`, not by CTest.

The Python that runs it has the wheel and NumPy, and the machine an OpenCL driver.
"""
import pathlib
import re
import sys
import tempfile
import time

BEGUN = time.perf_counter()
import navvy  # noqa: E402

# Python's isolated mode leaves out the folder of the script.
sys.path.append(str(pathlib.Path(__file__).parent))
import map_sites  # noqa: E402

# Of these the wheel must bring its own.
FOREIGN = "Bullet|sdformat|ignition|tinyxml|urdf|console_bridge|tinyobj|gdal|Coin|OpenCL|ompl|png"


def foreign_libraries():
    """Returns loaded libraries of these kinds that are not the wheel's."""
    lines = pathlib.Path("/proc/self/maps").read_text().splitlines()
    paths = {line.split()[-1] for line in lines if ".so" in line}
    names = {path for path in paths if re.search(FOREIGN, pathlib.Path(path).name, re.I)}
    return sorted(path for path in names if not path.startswith(sys.prefix))


def refuse_geotiff(folder):
    """Raises AssertionError unless a GeoTIFF is refused with its scene and a remedy."""
    (folder / "site.tif").write_bytes(b"II*\0" + bytes(100))
    scene = folder / "site.sdf"
    scene.write_text(map_sites.SCENE % ("site.tif", ""))
    try:
        navvy.World(navvy.Scene(scene))
    except navvy.InputError as error:
        fault = error.faults[0]
        assert fault.file == str(scene) and fault.line > 0, error
        assert "site.tif" in fault.value and "gdal_translate" in fault.remedy, error
        assert "libgdal" in fault.remedy, error
    else:
        raise AssertionError("a GeoTIFF was read without GDAL")


def main():
    assert navvy.__file__.startswith(sys.prefix), navvy.__file__
    assert not foreign_libraries(), foreign_libraries()
    assert "trench" in navvy.scenes(), navvy.scenes()
    scene = navvy.Scene("trench")
    with tempfile.TemporaryDirectory() as folder:
        map_sites.check_sites(navvy, folder)
        refuse_geotiff(pathlib.Path(folder))
    # Beside its trench, so that the first scoop comes at once.
    scene.machine["excavator"].pose = (-4, 0, 0, 0, 0, 0)
    world = navvy.Session(scene)
    print("device %s, world built after %.1f s" % (world.device, time.perf_counter() - BEGUN))
    # The wheel has a loader of its own, whose driver may bring whatever it needs.
    own = [path for path in foreign_libraries() if "libOpenCL" in path]
    assert not own, own
    while world.phase("excavator") != "swing" and world.time < 60:
        world.step(20)
    payload = world["excavator/bucket/payload"]
    print("%.0f kg in the bucket after %.1f s" % (payload, time.perf_counter() - BEGUN))
    assert payload > 700, payload


if __name__ == "__main__":
    main()
