// SPDX-License-Identifier: Apache-2.0
// How much work a file of somebody else's may ask for. Limits are counts (bytes, elements,
// triangles), never times, so that a file is refused on every machine or on none. They are meant to
// let a file up to 64 MB be refused or checked within about five seconds and 1 GB, and lie at ten
// times and more of what scenes are made of. The table for users is in scenarios/README.md;
// tests/scene_io/limits_test.cpp and its neighbours hold the numbers, bench/limits.py the costs.
#pragma once

#include <cstddef>

namespace navvy::limits {

inline constexpr std::size_t kMegabyte = std::size_t{1} << 20;

// Scene, machine and soil files.
inline constexpr std::size_t kXmlBytes = 16 * kMegabyte;  ///< of one file
/// Of one file, counted with those in comments.
inline constexpr std::size_t kXmlElements = 100'000;
inline constexpr std::size_t kXmlNesting = 64;  ///< elements inside each other
/// Models that are parts of each other.
inline constexpr std::size_t kModelNesting = 8;
inline constexpr std::size_t kXmlAttributes = 32;  ///< of one element
/// Of a name="..." and of an element's name.
inline constexpr std::size_t kNameBytes = 200;
/// Of all XML files that a scene is made of.
inline constexpr std::size_t kSceneBytes = 256 * kMegabyte;
/// XML files of a scene, a part's at each use.
inline constexpr std::size_t kSceneFiles = 2000;
/// Of a scene, an included file counted at each use.
inline constexpr std::size_t kSceneElements = 400'000;
/// Errors, and as many warnings, told one by one.
inline constexpr std::size_t kFaultsShown = 100;

// What a scene holds.
/// Included and as many in the file; cameras and lights too.
inline constexpr std::size_t kMachines = 500;
/// Columns and particles number them in a byte.
inline constexpr std::size_t kSoils = 255;
inline constexpr std::size_t kGroundLayers = 100;  ///< of a ground or a patch
/// Patches, awake boxes and shapes of a kind.
inline constexpr std::size_t kGroundParts = 1000;
inline constexpr std::size_t kMaterialPairs = 1000;  ///< of a table
inline constexpr std::size_t kSteps = 2000;          ///< of a program
/// Of a machine; joints, frames, cylinders, wheels likewise.
inline constexpr std::size_t kLinks = 300;
/// Visuals of a link, and as many collisions.
inline constexpr std::size_t kShapes = 200;
inline constexpr std::size_t kShells = 100;  ///< of a machine
/// Of one shell: particles near it are held against each.
inline constexpr std::size_t kShellTriangles = 5'000;
/// Of a scene: shells are cut to pieces of three cells.
inline constexpr std::size_t kShellPieces = 1'000'000;
inline constexpr double kParticles = 2e8;  ///< soil's budget; 216 bytes each

// Meshes.
inline constexpr std::size_t kObjBytes = 64 * kMegabyte;
inline constexpr std::size_t kObjLineBytes = 4096;
inline constexpr std::size_t kObjVertices = 2'000'000;
inline constexpr std::size_t kObjTriangles = 1'000'000;
inline constexpr std::size_t kObjCorners = 64;  ///< of one face
inline constexpr std::size_t kObjStatements =
    /// Lines that are neither vertices nor faces: groups, materials.
    100'000;
inline constexpr std::size_t kMtlFiles = 16;          ///< of one OBJ file
inline constexpr std::size_t kMtlBytes = kMegabyte;   ///< of one of them
inline constexpr std::size_t kHullVertices = 50'000;  ///< of a mesh that collides by its hull
inline constexpr std::size_t kSceneMeshes = 1000;     ///< files that shapes name
inline constexpr std::size_t kSceneMeshBytes = 512 * kMegabyte;  ///< of all, a shell's at each use
inline constexpr double kCoordinate = 1e6;                       ///< [m] of a mesh's vertex

// Maps. A map itself may be of any size: only what lies under the site is read.
/// Held at once, 100 MB; of larger ones windows are read.
inline constexpr double kMapCells = 2.5e7;
inline constexpr double kMapBlockBytes = 256e6;  ///< of a block that is read at once
inline constexpr double kMapDecodedBytes = 4e9;  ///< of all blocks under the site
/// Of a .prj, .aux.xml or world file beside it.
inline constexpr std::size_t kMapSidecarBytes = 4 * kMegabyte;
/// Of a number in an ESRI ASCII grid.
inline constexpr std::size_t kMapWordBytes = 64;
/// Of an ESRI ASCII grid, read from its first row on.
inline constexpr std::size_t kMapTextBytes = 1000 * kMegabyte;
inline constexpr std::size_t kNpyBytes = 512 * kMegabyte;  ///< of an NPY, which is held whole

// Design surfaces.
inline constexpr std::size_t kLandXmlBytes = 64 * kMegabyte;
/// Points and faces of all its surfaces are elements.
inline constexpr std::size_t kLandXmlElements = 1'500'000;
inline constexpr std::size_t kDesignCorners = 1000;  ///< of an area
inline constexpr std::size_t kDesignAreas = 100;

// Snapshots.
/// [m] of a machine or tool from the world's origin: no site lies there.
inline constexpr double kFarthest = 1e7;

}  // namespace navvy::limits
