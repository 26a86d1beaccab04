// SPDX-License-Identifier: Apache-2.0
// Limits on the work that an input file may cause. Limits are counts (bytes, elements, triangles),
// never times, so that a file is refused on every machine or on none. A file of up to 64 MB is
// thereby refused or checked within about five seconds and 1 GB of memory. The limits are at least
// ten times what scenes need. The table for users is docs/reference/limits.md;
// tests/scene_io/limits_test.cpp and its neighbours test the numbers, bench/limits.py measures the
// costs.
#pragma once

#include <cstddef>

namespace navvy::limits {

/// Bytes of one MiB.
inline constexpr std::size_t kMegabyte = std::size_t{1} << 20;

// Scene, machine and soil files.
/// /// Bytes of one XML file.
inline constexpr std::size_t kXmlBytes = 16 * kMegabyte;
/// /// Elements of one file, including those in comments.
inline constexpr std::size_t kXmlElements = 100'000;
/// /// Nesting depth of elements.
inline constexpr std::size_t kXmlNesting = 64;
/// /// Nesting depth of models that are parts of each other.
inline constexpr std::size_t kModelNesting = 8;
/// /// Attributes of one element.
inline constexpr std::size_t kXmlAttributes = 32;
/// /// Bytes of a name="..." and of an element's name.
inline constexpr std::size_t kNameBytes = 200;
/// /// Bytes of all XML files of a scene.
inline constexpr std::size_t kSceneBytes = 256 * kMegabyte;
/// /// XML files of a scene; a part's file counts at each use.
inline constexpr std::size_t kSceneFiles = 2000;
/// /// Elements of a scene; an included file counts at each use.
inline constexpr std::size_t kSceneElements = 400'000;
/// /// Errors that are reported one by one; the same number of warnings.
inline constexpr std::size_t kFaultsShown = 100;

// Content of a scene.
/// /// Machines that are included, and as many in the file; also cameras, and lights.
inline constexpr std::size_t kMachines = 500;
/// /// Soils: columns and particles store their index in a byte.
inline constexpr std::size_t kSoils = 255;
/// /// Layers of the ground or of a patch.
inline constexpr std::size_t kGroundLayers = 100;
/// /// Patches, active boxes, and shapes of each kind.
inline constexpr std::size_t kGroundParts = 1000;
/// /// Pairs of a table of materials.
inline constexpr std::size_t kMaterialPairs = 1000;
/// /// Steps of a program.
inline constexpr std::size_t kSteps = 2000;
/// /// Links of a machine; also joints, frames, cylinders, wheels.
inline constexpr std::size_t kLinks = 300;
/// /// Visuals of a link, and as many collisions.
inline constexpr std::size_t kShapes = 200;
/// /// Shells of a machine.
inline constexpr std::size_t kShells = 100;
/// /// Triangles of one shell: nearby particles are tested against each.
inline constexpr std::size_t kShellTriangles = 5'000;
/// /// Pieces of all shells of a scene: shells are cut into pieces of three cells.
inline constexpr std::size_t kShellPieces = 1'000'000;
/// /// Particle budget of the soil; 216 bytes each.
inline constexpr double kParticles = 2e8;

// Meshes.
/// Bytes of one OBJ file.
inline constexpr std::size_t kObjBytes = 64 * kMegabyte;
/// Bytes of one line of it.
inline constexpr std::size_t kObjLineBytes = 4096;
/// Vertices of one OBJ file.
inline constexpr std::size_t kObjVertices = 2'000'000;
/// Triangles of one OBJ file.
inline constexpr std::size_t kObjTriangles = 1'000'000;
/// /// Corners of one face.
inline constexpr std::size_t kObjCorners = 64;
inline constexpr std::size_t kObjStatements =
    /// /// Lines that are neither vertices nor faces: groups, materials.
    100'000;
/// /// Material files of one OBJ file.
inline constexpr std::size_t kMtlFiles = 16;
/// /// Bytes of one material file.
inline constexpr std::size_t kMtlBytes = kMegabyte;
/// /// Vertices of a mesh that collides by its hull.
inline constexpr std::size_t kHullVertices = 50'000;
/// /// Mesh files that shapes name.
inline constexpr std::size_t kSceneMeshes = 1000;
/// /// Bytes of all meshes of a scene; a shell's mesh counts at each use.
inline constexpr std::size_t kSceneMeshBytes = 512 * kMegabyte;
/// /// Largest coordinate of a mesh's vertex [m].
inline constexpr double kCoordinate = 1e6;

// Maps. A map may have any size: only the part under the site is read.
/// /// Cells in memory at once, 100 MB; larger maps are read through windows.
inline constexpr double kMapCells = 2.5e7;
/// /// Bytes of a block that is read at once.
inline constexpr double kMapBlockBytes = 256e6;
/// /// Bytes of all blocks under the site, decoded.
inline constexpr double kMapDecodedBytes = 4e9;
/// /// Bytes of a .prj, .aux.xml or world file beside the map.
inline constexpr std::size_t kMapSidecarBytes = 4 * kMegabyte;
/// /// Bytes of a number in an ESRI ASCII grid.
inline constexpr std::size_t kMapWordBytes = 64;
/// /// Bytes of an ESRI ASCII grid, from its first row on.
inline constexpr std::size_t kMapTextBytes = 1000 * kMegabyte;
/// /// Bytes of an NPY file, which is read whole.
inline constexpr std::size_t kNpyBytes = 512 * kMegabyte;

// Design surfaces.
/// Bytes of one LandXML file.
inline constexpr std::size_t kLandXmlBytes = 64 * kMegabyte;
/// /// Elements of a LandXML file; points and faces of all its surfaces are elements.
inline constexpr std::size_t kLandXmlElements = 1'500'000;
/// /// Corners of an area.
inline constexpr std::size_t kDesignCorners = 1000;
/// Areas of a design.
inline constexpr std::size_t kDesignAreas = 100;

// Snapshots.
/// /// Largest distance of a machine or tool from the world's origin [m]; no site is that far away.
inline constexpr double kFarthest = 1e7;

}  // namespace navvy::limits
