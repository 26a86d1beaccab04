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

/// Number of bytes in one MiB.
inline constexpr std::size_t kMegabyte = std::size_t{1} << 20;

// Scene, machine and soil files.
/// Maximum size of one XML file [bytes].
inline constexpr std::size_t kXmlBytes = 16 * kMegabyte;
/// Maximum number of elements in one XML file, including those in comments.
inline constexpr std::size_t kXmlElements = 100'000;
/// Maximum nesting depth of elements in an XML file.
inline constexpr std::size_t kXmlNesting = 64;
/// Maximum nesting depth of models that contain other models as parts.
inline constexpr std::size_t kModelNesting = 8;
/// Maximum number of attributes of one XML element.
inline constexpr std::size_t kXmlAttributes = 32;
/// Maximum length of an attribute name="..." and of the name of an XML element [bytes].
inline constexpr std::size_t kNameBytes = 200;
/// Maximum total size of all XML files of a scene [bytes].
inline constexpr std::size_t kSceneBytes = 256 * kMegabyte;
/// Maximum number of XML files of a scene; the file of a part counts at each use.
inline constexpr std::size_t kSceneFiles = 2000;
/// Maximum number of XML elements of a scene; those of an included file count at each use.
inline constexpr std::size_t kSceneElements = 400'000;
/// Maximum number of errors, and maximum number of warnings, that are reported individually.
inline constexpr std::size_t kFaultsShown = 100;

// Content of a scene.
/// Maximum number of machines that a scene includes, and number of machines in the scene file
/// itself; also the number of cameras, of lights, of hitches and of records.
inline constexpr std::size_t kMachines = 500;
/// Maximum number of soils; columns and particles store a soil's index in one byte.
inline constexpr std::size_t kSoils = 255;
/// Maximum number of layers of the ground or of a patch.
inline constexpr std::size_t kGroundLayers = 100;
/// Maximum number of patches, of active rectangles, and of shapes of each type.
inline constexpr std::size_t kGroundParts = 1000;
/// Maximum number of pairs in a table of materials.
inline constexpr std::size_t kMaterialPairs = 1000;
/// Maximum number of steps of a program.
inline constexpr std::size_t kSteps = 2000;
/// Maximum number of links of a machine; also of its joints, frames, cylinders and wheels.
inline constexpr std::size_t kLinks = 300;
/// Maximum number of visuals of a link, and number of its collisions.
inline constexpr std::size_t kShapes = 200;
/// Maximum number of shells of a machine.
inline constexpr std::size_t kShells = 100;
/// Maximum number of triangles of one shell; nearby particles are tested against each of them.
inline constexpr std::size_t kShellTriangles = 5'000;
/// Maximum total number of pieces into which the shells of a scene are divided (geometry/pieces.h).
inline constexpr std::size_t kShellPieces = 1'000'000;
/// Highest allowed value of the scene's limit on the number of particles. A particle takes 216
/// bytes.
inline constexpr double kParticles = 2e8;

// Meshes.
/// Maximum size of one OBJ file [bytes].
inline constexpr std::size_t kObjBytes = 64 * kMegabyte;
/// Maximum length of one line of an OBJ file [bytes].
inline constexpr std::size_t kObjLineBytes = 4096;
/// Maximum number of vertices of one OBJ file.
inline constexpr std::size_t kObjVertices = 2'000'000;
/// Maximum number of triangles of one OBJ file.
inline constexpr std::size_t kObjTriangles = 1'000'000;
/// Maximum number of corners of one face in an OBJ file.
inline constexpr std::size_t kObjCorners = 64;
/// Maximum number of lines of one OBJ file that are neither vertices nor faces, such as groups and
/// materials.
inline constexpr std::size_t kObjStatements = 100'000;
/// Maximum number of material files (MTL) that one OBJ file names.
inline constexpr std::size_t kMtlFiles = 16;
/// Maximum size of one material file (MTL) [bytes].
inline constexpr std::size_t kMtlBytes = kMegabyte;
/// Maximum number of vertices of a mesh whose convex hull is a collision shape.
inline constexpr std::size_t kHullVertices = 50'000;
/// Maximum number of mesh files that the shapes of a scene name.
inline constexpr std::size_t kSceneMeshes = 1000;
/// Maximum total size of all mesh files of a scene [bytes]; the mesh of a shell counts at each use.
inline constexpr std::size_t kSceneMeshBytes = 512 * kMegabyte;
/// Maximum absolute value of a vertex coordinate in a mesh [m].
inline constexpr double kCoordinate = 1e6;

// Maps. A map may have any size: only the part at the site is read.
/// Maximum number of map cells in memory at the same time, about 100 MB; larger maps are read in
/// parts.
inline constexpr double kMapCells = 2.5e7;
/// Maximum size of one block of a map, which must be read as a whole [bytes].
inline constexpr double kMapBlockBytes = 256e6;
/// Maximum decoded size of all map blocks that the site touches [bytes].
inline constexpr double kMapDecodedBytes = 4e9;
/// Maximum size of a .prj, .aux.xml or world file next to a map [bytes].
inline constexpr std::size_t kMapSidecarBytes = 4 * kMegabyte;
/// Maximum length of one number in an ESRI ASCII grid [bytes].
inline constexpr std::size_t kMapWordBytes = 64;
/// Maximum size of an ESRI ASCII grid without its header [bytes].
inline constexpr std::size_t kMapTextBytes = 1000 * kMegabyte;
/// Maximum size of an NPY file, which is read as a whole [bytes].
inline constexpr std::size_t kNpyBytes = 512 * kMegabyte;

// Design surfaces.
/// Maximum size of one LandXML file [bytes].
inline constexpr std::size_t kLandXmlBytes = 64 * kMegabyte;
/// Maximum number of elements in a LandXML file; each point and each face of any surface is an
/// element.
inline constexpr std::size_t kLandXmlElements = 1'500'000;
/// Maximum number of corners of one design area.
inline constexpr std::size_t kDesignCorners = 1000;
/// Maximum number of areas of a design.
inline constexpr std::size_t kDesignAreas = 100;

// Snapshots.
/// Maximum distance from the world's origin of a machine or tool in a snapshot [m]; no site is that
/// large.
inline constexpr double kFarthest = 1e7;

}  // namespace navvy::limits
