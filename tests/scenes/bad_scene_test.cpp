// Every way to write a wrong scene: the error names the file and the very line, and says what was expected.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "tests/scenes/scene_folder.h"

namespace arealab::bad_scene_test {
namespace {

struct BadScene {
  const char* name;
  std::string text;     // #HERE stands on the line that the error must name
  std::string message;  // after "file:line: "
};

void PrintTo(const BadScene& bad, std::ostream* stream) {
  *stream << bad.name;
}

std::string Light(const std::string& lines) {
  return kCamera + kMaterial + kSurface + "[[light]]\nname = \"lamp\"\n" + lines;
}
std::string Surface(const std::string& lines) {
  return kCamera + kMaterial + kLight + "[[surface]]\n" + lines;
}
std::string Material(const std::string& lines) {
  return kCamera + kLight + kSurface + "[[material]]\n" + lines;
}
std::string Camera(const std::string& lines) {
  return kMaterial + kLight + kSurface + "[camera]\n" + lines;
}

std::string Repeat(int count, const std::string& last) {
  std::string text = kCamera + kMaterial + kSurface;
  const std::string light =
      "[[light]]\nshape = \"sphere\"\nposition = [0.0, 0.0, 2.0]\nradius = 0.1\nradiance = 1.0\n";
  for (int i = 0; i < count; ++i) text += light;
  return text + last;
}

const std::string kRectangle =
    "shape = \"rectangle\"\nposition = [0.0, 0.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\n";
const std::string kEllipse = "shape = \"ellipse\"\nposition = [0, 0, 1]\nnormal = [0, 0, -1]\n";
const std::string kPolygon = "shape = \"polygon\"\nposition = [0, 0, 1]\nnormal = [0, 0, -1]\n";
const std::string kTube = "shape = \"tube\"\nposition = [0, 0, 1]\n";
const std::string kCornersExpected = "[[x, y], …], the 3 to 8 corners of a convex outline in metres, no three in a line";
const std::string kSized = kRectangle + "size = [1.0, 0.5]\n";

std::vector<BadScene> BadScenes() {
  return {
      {"Syntax", kCamera + "units = \"radiometric #HERE\n",
       "Error while parsing string: unescaped control characters other than TAB (U+0009) are explicitly "
       "prohibited; expected valid TOML"},
      {"SyntaxNoValue", "exposure = #HERE\n" + kCamera,
       "Error while parsing key-value pair: expected value, saw '#'; expected valid TOML"},
      {"RepeatedKey", "exposure = 1.0\nexposure = 2.0 #HERE\n" + kCamera,
       "Error while parsing key-value pair: cannot redefine existing floating-point 'exposure'; expected "
       "valid TOML"},
      {"EmptyFile", "#HERE\n", "the scene has no camera; expected a table [camera] with position and target"},
      {"UnknownKeyAtTop", "exposur = 1.0 #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "unknown key 'exposur' in the scene; expected 'exposure'"},
      {"UnknownBrdf", "brdf = \"beckman\" #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'brdf' in the scene is 'beckman'; expected 'beckmann'"},
      {"UnknownDiffuse", "diffuse = \"burley\" #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'diffuse' in the scene is 'burley'; expected one of: lambert, disney"},
      {"DiffuseUnderASky", "diffuse = \"disney\" #HERE\n" + kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1.0\n",
       "the diffuse BRDF disney reflects no sky here; expected \"lambert\""},
      {"UnknownUnits", "units = \"photometrc\" #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'units' in the scene is 'photometrc'; expected 'photometric'"},
      {"ExposureIsText", "exposure = \"bright\" #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'exposure' in the scene is a string; expected stops (EV) from -64 to 64"},
      {"ExposureAbsurd", "exposure = 1000 #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'exposure' in the scene is 1000; expected stops (EV) from -64 to 64"},
      {"SkyIsNumber", "sky = 1 #HERE\n" + kCamera + kMaterial + kSurface + kLight,
       "'sky' in the scene is an integer; expected a table [sky]"},
      {"SkyUnknownKey", kCamera + kMaterial + kSurface + kLight + "[sky]\nflux = 1 #HERE\n",
       "unknown key 'flux' in [sky]; expected one of: radiance, luminance, color, texture, rotation"},
      {"SkyWithoutRadiance", kCamera + kMaterial + kSurface + kLight + "[sky] #HERE\n",
       "[sky] has no 'radiance'; expected a positive number, at most 1e12"},
      {"SkyBlack", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 0 #HERE\n",
       "[sky] emits nothing; expected a positive number, at most 1e12"},
      {"SkyNan", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = [1, nan, 1] #HERE\n",
       "'radiance[1]' in [sky] is nan, not a finite number; expected a positive number, at most 1e12"},
      {"SkyTextureMissing", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1\ntexture = \"dusk.exr\" #HERE\n",
       "no file 'dusk.exr'; expected a file in the scene's folder"},
      {"SkyTextureNan", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1\ntexture = \"nan.exr\" #HERE\n",
       "'nan.exr' has a pixel that is not finite at (1, 0); expected finite values"},
      {"SkyTextureSquare", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1\ntexture = \"red.ppm\" #HERE\n",
       "'red.ppm' is 1 × 1 pixels; expected a sky in latitude and longitude, twice as wide as high"},
      {"SkyTurnedWithoutTexture", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1\nrotation = 90 #HERE\n",
       "'rotation' turns a sky without a texture; expected both or neither"},
      {"SkyInOtherUnits", kCamera + kMaterial + kSurface + kLight + "[sky]\nluminance = 1 #HERE\n",
       "'luminance' is a photometric quantity and this scene's units are radiometric; expected 'radiance'"},
      {"SkyColorBlack", kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = 1\ncolor = [0, 0, 0] #HERE\n",
       "the sky's color is black; expected numbers from 0 to 1e6, not all zero"},
      {"SkyColorBesideNumbers",
       kCamera + kMaterial + kSurface + kLight + "[sky]\nradiance = [1, 1, 1]\ncolor = [1, 0, 0] #HERE\n",
       "'color' stands beside three numbers of 'radiance'; expected one or the other"},
      {"NoCamera", "# Where? #HERE\n" + kMaterial + kSurface + kLight,
       "the scene has no camera; expected a table [camera] with position and target"},
      {"CameraIsNumber", "camera = 1 #HERE\n" + kMaterial + kSurface + kLight,
       "'camera' in the scene is an integer; expected a table [camera]"},
      {"CameraUnknownKey", Camera("position = [0, -4, 1]\ntraget = [0, 0, 0] #HERE\n"),
       "unknown key 'traget' in [camera]; expected 'target'"},
      {"CameraNoTarget", kMaterial + kLight + kSurface + "[camera] #HERE\nposition = [0, -4, 1]\n",
       "[camera] has no 'target'; expected an array of 3 numbers, metres"},
      {"CameraTwoNumbers", Camera("position = [0, -4] #HERE\ntarget = [0, 0, 0]\n"),
       "'position' in [camera] has 2 elements; expected an array of 3 numbers"},
      {"CameraNan", Camera("position = [0, nan, 1] #HERE\ntarget = [0, 0, 0]\n"),
       "'position[1]' in [camera] is nan, not a finite number; expected metres, at most 1e7 either way"},
      {"CameraInf", Camera("position = [0, 0, 1]\ntarget = [\n0, \n-inf, #HERE\n 0]\n"),
       "'target[1]' in [camera] is -inf, not a finite number; expected metres, at most 1e7 either way"},
      {"CameraFar", Camera("position = [0, 0, 2e7] #HERE\ntarget = [0, 0, 0]\n"),
       "'position[2]' in [camera] is 20000000; expected metres, at most 1e7 either way"},
      {"CameraOnTarget", Camera("position = [0, 0, 1]\ntarget = [0, 0, 1] #HERE\n"),
       "the camera's target is its position; expected two different points"},
      {"CameraUpParallel", Camera("position = [0, 0, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 3] #HERE\n"),
       "the camera looks along its up direction; expected 'up' to lean against the line of sight"},
      {"CameraLooksDown", Camera("position = [0, 0, 1]\ntarget = [0, 0, 0] #HERE\n"),
       "the camera looks along its up direction; expected 'up' to lean against the line of sight"},
      {"CameraUpZero", Camera("position = [0, -4, 1]\ntarget = [0, 0, 0]\nup = [0, 0, 0] #HERE\n"),
       "the camera's up is zero; expected a direction"},
      {"FieldOfViewZero", Camera("position = [0, -4, 1]\ntarget = [0, 0, 0]\nvertical_fov = 0 #HERE\n"),
       "'vertical_fov' in [camera] is 0; expected degrees above 0 and below 170"},
      {"FieldOfViewWide", Camera("position = [0, -4, 1]\ntarget = [0, 0, 0]\nvertical_fov = 170.0 #HERE\n"),
       "'vertical_fov' in [camera] is 170; expected degrees above 0 and below 170"},
      {"MaterialWithoutName", kCamera + kLight + kSurface + "[[material]] #HERE\nroughness = 0.5\n",
       "[[material]] has no 'name'; expected a name that surfaces refer to"},
      {"MaterialNameIsNumber", Material("name = 7 #HERE\n"),
       "'name' in [[material]] is an integer; expected a string"},
      {"MaterialNameEmpty", Material("name = \"\" #HERE\n"),
       "'name' in [[material]] '' has 0 characters; expected 1 to 100"},
      {"MaterialTwice", kCamera + kLight + kSurface + kMaterial + "[[material]]\nname = \"grey\" #HERE\n",
       "the name 'grey' is taken; expected another name for [[material]] 'grey'"},
      {"MaterialUnknownKey", Material("name = \"grey\"\nroughnes = 0.5 #HERE\n"),
       "unknown key 'roughnes' in [[material]] 'grey'; expected 'roughness'"},
      {"MaterialStrangeKey", Material("name = \"grey\"\nrefraction = 0.5 #HERE\n"),
       "unknown key 'refraction' in [[material]] 'grey'; expected one of: name, base_color, roughness, "
       "metalness, specular, base_color_texture, metallic_roughness_texture, normal_texture, normal_scale"},
      {"MaterialIsTable", kCamera + kLight + kSurface + "[material] #HERE\nname = \"grey\"\n",
       "'material' in the scene is a table; expected tables, each headed [[material]]"},
      {"RoughnessAboveOne", Material("name = \"grey\"\nroughness = 1.5 #HERE\n"),
       "'roughness' in [[material]] 'grey' is 1.5; expected a number from 0 to 1"},
      {"RoughnessNegative", Material("name = \"grey\"\nroughness = [0.1, -0.1] #HERE\n"),
       "'roughness[1]' in [[material]] 'grey' is -0.1; expected a number from 0 to 1"},
      {"RoughnessThreeNumbers", Material("name = \"grey\"\nroughness = [0.1, 0.2, 0.3] #HERE\n"),
       "'roughness' in [[material]] 'grey' has 3 elements; expected an array of 2 numbers"},
      {"RoughnessNan", Material("name = \"grey\"\nroughness = nan #HERE\n"),
       "'roughness' in [[material]] 'grey' is nan, not a finite number; expected a number from 0 to 1"},
      {"RoughnessIsText", Material("name = \"grey\"\nroughness = \"low\" #HERE\n"),
       "'roughness' in [[material]] 'grey' is a string; expected one number or an array of 2"},
      {"MetalnessAboveOne", Material("name = \"grey\"\nmetalness = 1.01 #HERE\n"),
       "'metalness' in [[material]] 'grey' is 1.01; expected a number from 0 to 1"},
      {"MetalnessIsBool", Material("name = \"grey\"\nmetalness = true #HERE\n"),
       "'metalness' in [[material]] 'grey' is a boolean; expected a number from 0 to 1"},
      {"SpecularOfAMetal", Material("name = \"grey\"\nmetalness = 0.5\nspecular = 0.5 #HERE\n"),
       "specular weighs a non-metal's lobe; expected no metalness beside it"},
      {"BaseColorAboveOne", Material("name = \"grey\"\nbase_color = [0.5, 1.2, 0.5] #HERE\n"),
       "'base_color[1]' in [[material]] 'grey' is 1.2; expected a number from 0 to 1"},
      {"BaseColorNegative", Material("name = \"grey\"\nbase_color = -0.1 #HERE\n"),
       "'base_color' in [[material]] 'grey' is -0.1; expected a number from 0 to 1"},
      {"TextureMissing", Material("name = \"grey\"\nbase_color_texture = \"wood.png\" #HERE\n"),
       "no file 'wood.png'; expected a file in the scene's folder"},
      {"TextureNotAnImage", Material("name = \"grey\"\nbase_color_texture = \"not_an_image.png\" #HERE\n"),
       "'not_an_image.png' is not an image that can be read; expected a whole PNG, JPEG, EXR, HDR, TGA or "
       "TIFF file"},
      {"TextureLeavesFolder", Material("name = \"grey\"\nnormal_texture = \"../secret.png\" #HERE\n"),
       "'../secret.png' leaves the scene's folder; expected a path inside it, links followed"},
      {"TextureLeavesByLink", Material("name = \"grey\"\nmetallic_roughness_texture = \"link.png\" #HERE\n"),
       "'link.png' leaves the scene's folder; expected a path inside it, links followed"},
      {"TextureLeavesByLinkedFolder",
       Material("name = \"grey\"\nbase_color_texture = \"way_out/secret.png\" #HERE\n"),
       "'way_out/secret.png' leaves the scene's folder; expected a path inside it, links followed"},
      {"TextureAbsolute", Material("name = \"grey\"\nbase_color_texture = \"/etc/passwd\" #HERE\n"),
       "'/etc/passwd' is an absolute path; expected a path relative to the scene's folder"},
      {"TextureNameEmpty", Material("name = \"grey\"\nbase_color_texture = \"\" #HERE\n"),
       "the file's name is empty or has control characters; expected a path in the scene's folder"},
      {"TextureNameWithZero",
       Material("name = \"grey\"\nbase_color_texture = \"link.png\\u0000.png\" #HERE\n"),
       "the file's name is empty or has control characters; expected a path in the scene's folder"},
      {"TextureIsNumber", Material("name = \"grey\"\nbase_color_texture = 3 #HERE\n"),
       "'base_color_texture' in [[material]] 'grey' is an integer; expected a path as a string"},
      {"TextureLeavesPackage",
       Material("name = \"grey\"\nbase_color_texture = \"glmark2-data:../../../etc/passwd\" #HERE\n"),
       "'../../../etc/passwd' leaves the Debian package glmark2-data; expected a path inside it, links "
       "followed"},
      {"NormalScaleNegative", Material("name = \"grey\"\nnormal_scale = -1 #HERE\n"),
       "'normal_scale' in [[material]] 'grey' is -1; expected a number from 0 to 16"},
      {"LightTextureMissing", Light(kSized + "radiance = 1.0\ntexture = \"wood.png\" #HERE\n"),
       "no file 'wood.png'; expected a file in the scene's folder"},
      {"LightTextureNotAnImage", Light(kSized + "radiance = 1.0\ntexture = \"not_an_image.png\" #HERE\n"),
       "'not_an_image.png' is not an image that can be read; expected a whole PNG, JPEG, EXR, HDR, TGA or TIFF file"},
      {"LightTextureLeavesFolder", Light(kSized + "radiance = 1.0\ntexture = \"../secret.png\" #HERE\n"),
       "'../secret.png' leaves the scene's folder; expected a path inside it, links followed"},
      {"LightTextureIsNumber", Light(kSized + "radiance = 1.0\ntexture = 3 #HERE\n"),
       "'texture' in [[light]] 'lamp' is an integer; expected a path as a string"},
      {"LightTextureNegative", Light(kSized + "radiance = 1.0\ntexture = \"negative.exr\" #HERE\n"),
       "'negative.exr' has a negative pixel at (1, 0); expected a light's texels to be 0 or more"},
      {"LightTextureNan", Light(kSized + "radiance = 1.0\ntexture = \"nan.exr\" #HERE\n"),
       "'nan.exr' has a pixel that is not finite at (1, 0); expected finite values"},
      {"LightTextureBlack", Light(kSized + "radiance = 1.0\ntexture = \"black.ppm\" #HERE\n"),
       "'black.ppm' is black; expected a light's texture to emit something"},
      {"LightTextureOnADisk",
       Light("shape = \"disk\"\nposition = [0, 0, 2]\ntarget = [0, 0, 0]\nradius = 1.0\nradiance = 1.0\ntexture = \"red.ppm\" #HERE\n"),
       "'texture' in [[light]] 'lamp' stands on a disk; expected a rectangle"},
      {"LightTextureWithoutItsColor", Light(kSized + "radiance = 1.0\ntexture = \"red.ppm\"\ncolor = [0.0, 1.0, 0.0] #HERE\n"),
       "the light's color and its texture have no channel in common; expected numbers from 0 to 1e6, not all zero"},
      {"NoSurface", "# Nothing? #HERE\n" + kCamera + kMaterial + kLight,
       "the scene has no surfaces; expected at least one [[surface]]"},
      {"SurfaceWithoutType", kCamera + kMaterial + kLight + "[[surface]] #HERE\nsize = [1, 1]\n",
       "[[surface]] has no 'type'; expected one of: box, height_field, mesh, plane, sphere"},
      {"SurfaceUnknownType", Surface("type = \"cube\" #HERE\n"),
       "'type' in [[surface]] is 'cube'; expected one of: box, height_field, mesh, plane, sphere"},
      {"SurfaceUnknownKey", Surface("type = \"box\"\nradius = 1 #HERE\n"),
       "unknown key 'radius' in [[surface]] of type 'box'; expected one of: type, position, rotation, "
       "material, size"},
      {"SurfaceUnknownMaterial", Surface("type = \"plane\"\nsize = [1, 1]\nmaterial = \"gray\" #HERE\n"),
       "no material 'gray'; expected 'grey'"},
      {"SurfaceWithoutMaterial",
       kCamera + kMaterial + kLight + "[[surface]] #HERE\ntype = \"plane\"\nsize = [1, 1]\n",
       "[[surface]] of type 'plane' has no 'material'; expected the name of a [[material]]: grey"},
      {"SurfaceButNoMaterials",
       kCamera + kLight + "[[surface]]\ntype = \"plane\"\nsize = [1, 1]\nmaterial = \"grey\" #HERE\n",
       "[[surface]] of type 'plane' needs a material and the scene has none; expected a [[material]]"},
      {"PlaneWithoutSize",
       kCamera + kMaterial + kLight + "[[surface]] #HERE\ntype = \"plane\"\nmaterial = \"grey\"\n",
       "[[surface]] of type 'plane' has no 'size'; expected an array of 2 lengths in metres"},
      {"PlaneNegativeSize", Surface("type = \"plane\"\nsize = [1, -1] #HERE\nmaterial = \"grey\"\n"),
       "'size[1]' in [[surface]] of type 'plane' is -1; expected a positive length in metres, 1e-6 to 1e7"},
      {"SphereZeroRadius", Surface("type = \"sphere\"\nradius = 0 #HERE\nmaterial = \"grey\"\n"),
       "'radius' in [[surface]] of type 'sphere' is 0; expected a positive length in metres, 1e-6 to 1e7"},
      {"BoxHuge", Surface("type = \"box\"\nsize = [1, 1, 1e8] #HERE\nmaterial = \"grey\"\n"),
       "'size[2]' in [[surface]] of type 'box' is 100000000; expected a positive length in metres, 1e-6 to "
       "1e7"},
      {"PositionInf",
       Surface("type = \"box\"\nsize = [1, 1, 1]\nposition = [inf, 0, 0] #HERE\nmaterial = \"grey\"\n"),
       "'position[0]' in [[surface]] of type 'box' is inf, not a finite number; expected metres, at most 1e7 "
       "either way"},
      {"RotationNan",
       Surface("type = \"box\"\nsize = [1, 1, 1]\nrotation = [0, 0, nan] #HERE\nmaterial = \"grey\"\n"),
       "'rotation[2]' in [[surface]] of type 'box' is nan, not a finite number; expected degrees, at most "
       "36000 either way"},
      {"HeightFieldOfNothing",
       kCamera + kMaterial + kLight +
           "[[surface]] #HERE\ntype = \"height_field\"\nsize = [1, 1]\nheight = 1\nmaterial = \"grey\"\n",
       "a height field has one of 'formula' and 'image'; expected exactly one"},
      {"HeightFieldUnknownFormula",
       Surface("type = \"height_field\"\nsize = [1, 1]\nheight = 1\nformula = \"wave\" #HERE\nwavelength = "
               "1\nmaterial = \"grey\"\n"),
       "'formula' in [[surface]] of type 'height_field' is 'wave'; expected 'waves'"},
      {"HeightFieldHalfCells",
       Surface("type = \"height_field\"\nsize = [1, 1]\nheight = 1\nformula = \"waves\"\nwavelength = "
               "1\ncells = [4.5, 4] #HERE\nmaterial = \"grey\"\n"),
       "'cells' is not whole; expected whole numbers of cells along x and y, 1 to 2048"},
      {"HeightFieldManyCells",
       Surface("type = \"height_field\"\nsize = [1, 1]\nheight = 1\nformula = \"waves\"\nwavelength = "
               "1\ncells = [100000, 4] #HERE\nmaterial = \"grey\"\n"),
       "'cells[0]' in [[surface]] of type 'height_field' is 100000; expected whole numbers of cells along x "
       "and y, 1 to 2048"},
      {"MeshMissing", Surface("type = \"mesh\"\nfile = \"teapot.obj\" #HERE\nmaterial = \"grey\"\n"),
       "no file 'teapot.obj'; expected a file in the scene's folder"},
      {"MeshWithoutFile",
       kCamera + kMaterial + kLight + "[[surface]] #HERE\ntype = \"mesh\"\nmaterial = \"grey\"\n",
       "[[surface]] of type 'mesh' has no 'file'; expected the path of a mesh"},
      {"MeshLeavesFolder", Surface("type = \"mesh\"\nfile = \"../secret.obj\" #HERE\nmaterial = \"grey\"\n"),
       "'../secret.obj' leaves the scene's folder; expected a path inside it, links followed"},
      {"MeshBufferLeavesFolder", Surface("type = \"mesh\"\nfile = \"buffer_outside.gltf\" #HERE\n"),
       "'buffer_outside.gltf' refers to 'secret.bin', which leaves the scene's folder; expected files inside "
       "it"},
      {"MeshOfPoints", Surface("type = \"mesh\"\nfile = \"points.obj\" #HERE\nmaterial = \"grey\"\n"),
       "'points.obj' has no triangles; expected at least one with an area"},
      {"MeshWithoutArea", Surface("type = \"mesh\"\nfile = \"flat.obj\" #HERE\nmaterial = \"grey\"\n"),
       "'flat.obj' has no triangles; expected at least one with an area"},
      {"MeshNan", Surface("type = \"mesh\"\nfile = \"nan.obj\" #HERE\nmaterial = \"grey\"\n"),
       "vertex 2 of 'nan.obj' is not finite; expected finite positions"},
      {"MeshInf", Surface("type = \"mesh\"\nfile = \"inf.ply\" #HERE\nmaterial = \"grey\"\n"),
       "vertex 2 of 'inf.ply' is not finite; expected finite positions"},
      {"MeshBroken", Surface("type = \"mesh\"\nfile = \"broken.gltf\" #HERE\nmaterial = \"grey\"\n"),
       "'broken.gltf' cannot be read as a mesh (No suitable reader found for the file format of file "
       "\"broken.gltf\".); expected a valid .gltf file"},
      {"MeshUnknownFormat", Surface("type = \"mesh\"\nfile = \"words.txt\" #HERE\nmaterial = \"grey\"\n"),
       "'words.txt' is not a mesh format that is read; expected .gltf, .glb, .obj, .ply, .stl or .3ds"},
      {"MeshWithoutMaterial",
       kCamera + kMaterial + kLight + "[[surface]] #HERE\ntype = \"mesh\"\nfile = \"triangle.obj\"\n",
       "[[surface]] of type 'mesh' has no 'material'; expected the name of a [[material]]: grey"},
      {"MeshScaleAndHeight",
       Surface(
           "type = \"mesh\"\nfile = \"triangle.obj\"\nscale = 2\nheight = 1 #HERE\nmaterial = \"grey\"\n"),
       "both 'height' and 'scale' are given; expected one of them"},
      {"MeshScaleNegative",
       Surface("type = \"mesh\"\nfile = \"triangle.obj\"\nscale = -2 #HERE\nmaterial = \"grey\"\n"),
       "'scale' in [[surface]] of type 'mesh' is -2; expected a positive factor, 1e-9 to 1e9"},
      {"MeshFlatHeight",
       Surface("type = \"mesh\"\nfile = \"triangle.obj\"\nheight = 1 #HERE\nmaterial = \"grey\"\n"),
       "the mesh is flat and level; expected 'scale' instead of 'height'"},
      {"MeshTooFar",
       Surface("type = \"mesh\"\nfile = \"triangle.obj\" #HERE\nscale = 1e8\nmaterial = \"grey\"\n"),
       "the mesh reaches 100000000 m; expected metres, at most 1e7 either way"},
      {"MeshWithoutCoordinatesForRamp",
       kCamera + kLight +
           "[[material]]\nname = \"ramp\"\nroughness = [0.1, 0.9]\n[[surface]]\ntype = \"mesh\"\nfile = "
           "\"triangle.obj\" #HERE\nmaterial = \"ramp\"\n",
       "'triangle.obj' has no texture coordinates and its material 'ramp' has a texture or a roughness ramp; "
       "expected a mesh with them or a plain material"},
      {"NoLight", "# Dark? #HERE\n" + kCamera + kMaterial + kSurface,
       "the scene has no lights; expected at least one [[light]]"},
      {"TooManyLights", Repeat(256, "[[light]] #HERE\nshape = \"sphere\"\n"),
       "the scene has 257 lights; expected at most 256"},
      {"LightUnknownShape", Light("shape = \"sphare\" #HERE\n"),
       "'shape' in [[light]] 'lamp' is 'sphare'; expected 'sphere'"},
      {"LightUnknownKey", Light("intensity = 3 #HERE\n" + kSized),
       "unknown key 'intensity' in [[light]] 'lamp'; expected one of: name, shape, position, color, "
       "radiance, flux, luminance, luminous_flux, texture, size, target, normal, rotation, up, two_sided"},
      {"LightNameTwice",
       kCamera + kMaterial + kSurface + kLight + "[[light]]\nname = \"lamp\" #HERE\n" + kSized +
           "radiance = 1\n",
       "the name 'lamp' is taken; expected another name for [[light]] 'lamp'"},
      {"LightZeroArea", Light(kRectangle + "size = [1.0, 0.0] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has no area; expected a positive length in metres, 1e-6 to 1e7"},
      {"LightNegativeSize", Light(kRectangle + "size = [-1.0, 1.0] #HERE\nradiance = 1\n"),
       "'size[0]' in [[light]] 'lamp' is -1; expected a positive length in metres, 1e-6 to 1e7"},
      {"LightTinySize", Light(kRectangle + "size = [1e-9, 1.0] #HERE\nradiance = 1\n"),
       "'size[0]' in [[light]] 'lamp' is 1e-09; expected a positive length in metres, 1e-6 to 1e7"},
      {"LightZeroRadius",
       Light("shape = \"disk\"\nposition = [0, 0, 1]\nnormal = [0, 0, -1]\nradius = 0 #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has no area; expected a positive length in metres, 1e-6 to 1e7"},
      {"LightNegativeRadius",
       Light("shape = \"sphere\"\nposition = [0, 0, 1]\nradius = -2 #HERE\nradiance = 1\n"),
       "'radius' in [[light]] 'lamp' is -2; expected a positive length in metres, 1e-6 to 1e7"},
      {"EllipseZeroRadius", Light(kEllipse + "radii = [1.0, 0.0] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has no area; expected a positive length in metres, 1e-6 to 1e7"},
      {"EllipseOneRadius", Light(kEllipse + "radii = [1.0] #HERE\nradiance = 1\n"),
       "'radii' in [[light]] 'lamp' has 1 elements; expected an array of 2 numbers"},
      {"EllipseHasNoRadius", Light(kEllipse + "radius = 1.0 #HERE\nradiance = 1\n"),
       "unknown key 'radius' in [[light]] 'lamp'; expected one of: name, shape, position, color, radiance, flux, luminance, luminous_flux, texture, "
       "radii, target, normal, rotation, up, two_sided"},
      {"TubeZeroRadius", Light(kTube + "axis = [1, 0, 0]\nlength = 1\nradius = 0 #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has no area; expected a positive length in metres, 1e-6 to 1e7"},
      {"TubeZeroLength", Light(kTube + "axis = [1, 0, 0]\nradius = 1\nlength = 0 #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has no area; expected a positive length in metres, 1e-6 to 1e7"},
      {"TubeNegativeLength", Light(kTube + "axis = [1, 0, 0]\nradius = 1\nlength = -2 #HERE\nradiance = 1\n"),
       "'length' in [[light]] 'lamp' is -2; expected a positive length in metres, 1e-6 to 1e7"},
      {"TubeNanLength", Light(kTube + "axis = [1, 0, 0]\nradius = 1\nlength = nan #HERE\nradiance = 1\n"),
       "'length' in [[light]] 'lamp' is nan, not a finite number; expected a positive length in metres, 1e-6 to 1e7"},
      {"TubeLengthMissing", kCamera + kMaterial + kSurface + "[[light]] #HERE\n" + kTube + "axis = [1, 0, 0]\nradius = 1\nradiance = 1\n",
       "[[light]] has no 'length'; expected a positive length in metres, 1e-6 to 1e7"},
      {"TubeZeroAxis", Light(kTube + "radius = 1\nlength = 2\naxis = [0, 0, 0] #HERE\nradiance = 1\n"),
       "the tube's axis is zero; expected a direction"},
      {"TubeNoAxis", kCamera + kMaterial + kSurface + "[[light]] #HERE\n" + kTube + "length = 2\nradius = 1\nradiance = 1\n",
       "[[light]] has neither of 'axis' and 'rotation'; expected exactly one"},
      {"TubeAxisAndRotation", Light(kTube + "radius = 1\nlength = 2\nrotation = [0, 0, 9]\naxis = [1, 0, 0] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has both 'axis' and 'rotation'; expected exactly one"},
      {"TubeTwoSided", Light(kTube + "radius = 1\nlength = 2\naxis = [1, 0, 0]\ntwo_sided = true #HERE\nradiance = 1\n"),
       "unknown key 'two_sided' in [[light]] 'lamp'; expected one of: name, shape, position, color, radiance, flux, luminance, luminous_flux, texture, "
       "radius, length, axis, rotation"},
      {"TubeTexture", Light(kTube + "radius = 1\nlength = 2\naxis = [1, 0, 0]\ntexture = \"a.png\" #HERE\nradiance = 1\n"),
       "'texture' in [[light]] 'lamp' stands on a tube; expected a rectangle"},
      {"PolygonCornersMissing",
       kCamera + kMaterial + kSurface + "[[light]] #HERE\n" + kPolygon + "radiance = 1\n",
       "[[light]] has no 'corners'; expected " + kCornersExpected},
      {"PolygonCornersNumber", Light(kPolygon + "corners = 3 #HERE\nradiance = 1\n"),
       "'corners' in [[light]] 'lamp' is an integer; expected " + kCornersExpected},
      {"PolygonTwoCorners", Light(kPolygon + "corners = [[0, 0], [1, 0]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': 2 corners enclose nothing; expected " + kCornersExpected},
      {"PolygonNineCorners",
       Light(kPolygon + "corners = [[0, 0], [1, 0], [2, 1], [3, 3], [3, 4], [2, 6], [1, 7], [0, 7], [-1, 3]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': 9 corners are too many; expected " + kCornersExpected},
      {"PolygonEqualCorners", Light(kPolygon + "corners = [[0, 0], [1, 0], [1, 0], [0, 1]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': corners 2 and 3 are the same; expected " + kCornersExpected},
      {"PolygonCollinear", Light(kPolygon + "corners = [[0, 0], [1, 0], [2, 0], [1, 1]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': corner 2 lies in a line with its neighbours; expected " + kCornersExpected},
      {"PolygonZeroArea", Light(kPolygon + "corners = [[0, 0], [1, 1], [2, 2]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': corner 1 lies in a line with its neighbours; expected " + kCornersExpected},
      {"PolygonTinyArea", Light(kPolygon + "corners = [[0, 0], [1e-7, 0], [0, 1e-7]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': it has no area; expected " + kCornersExpected},
      {"PolygonNotConvex", Light(kPolygon + "corners = [[0, 0], [2, 0], [0.5, 0.5], [0, 2]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': the outline turns in at corner 3; expected " + kCornersExpected},
      {"PolygonStar",
       Light(kPolygon + "corners = [[0, 1], [0.6, -0.8], [-1, 0.3], [1, 0.3], [-0.6, -0.8]] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp': the outline crosses itself; expected " + kCornersExpected},
      {"PolygonNan", Light(kPolygon + "corners = [[0, 0], [1, 0], [nan, 1]] #HERE\nradiance = 1\n"),
       "'corners[2][0]' in [[light]] 'lamp' is nan, not a finite number; expected metres, at most 1e7 either way"},
      {"PolygonFlatCorner", Light(kPolygon + "corners = [[0, 0], [1, 0], [0, 1, 2]] #HERE\nradiance = 1\n"),
       "'corners[2]' in [[light]] 'lamp' has 3 elements; expected an array of 2 numbers"},
      {"SphereHasNoTarget",
       Light(
           "shape = \"sphere\"\nposition = [0, 0, 1]\nradius = 2\ntarget = [0, 0, 0] #HERE\nradiance = 1\n"),
       "unknown key 'target' in [[light]] 'lamp'; expected one of: name, shape, position, color, radiance, "
       "flux, luminance, luminous_flux, texture, radius"},
      {"LightWithoutDirection",
       kCamera + kMaterial + kSurface +
           "[[light]] #HERE\nshape = \"disk\"\nposition = [0, 0, 1]\nradius = 1\nradiance = 1\n",
       "[[light]] has none of 'target', 'normal' and 'rotation'; expected exactly one"},
      {"LightTwoDirections", Light(kSized + "normal = [0, 0, -1] #HERE\nradiance = 1\n"),
       "[[light]] 'lamp' has more than one of 'target', 'normal' and 'rotation'; expected exactly one"},
      {"LightOnTarget",
       Light("shape = \"disk\"\nposition = [0, 0, 1]\ntarget = [0, 0, 1] #HERE\nradius = 1\nradiance = 1\n"),
       "the light's target is its position; expected two different points"},
      {"LightNormalZero",
       Light("shape = \"disk\"\nposition = [0, 0, 1]\nnormal = [0, 0, 0] #HERE\nradius = 1\nradiance = 1\n"),
       "the light's normal is zero; expected a direction"},
      {"LightUpParallel", Light(kSized + "up = [0, 0, 1] #HERE\nradiance = 1\n"),
       "the light's up is parallel to its normal; expected it to lean against it"},
      {"LightUpBesideRotation",
       Light("shape = \"disk\"\nposition = [0, 0, 1]\nrotation = [0, 0, 0]\nup = [0, 1, 0] #HERE\nradius = "
             "1\nradiance = 1\n"),
       "'up' has no meaning beside 'rotation'; expected one of the two"},
      {"LightFar", Light("shape = \"sphere\"\nposition = [0, 0, 1e9] #HERE\nradius = 1\nradiance = 1\n"),
       "'position[2]' in [[light]] 'lamp' is 1000000000; expected metres, at most 1e7 either way"},
      {"LightTwoSidedIsNumber", Light(kSized + "two_sided = 1 #HERE\nradiance = 1\n"),
       "'two_sided' in [[light]] 'lamp' is an integer; expected true or false"},
      {"LightWithoutEmission", kCamera + kMaterial + kSurface + "[[light]] #HERE\n" + kSized,
       "[[light]] has neither of 'radiance' and 'flux'; expected exactly one"},
      {"LightTwoEmissions", Light(kSized + "radiance = 1\nflux = 1 #HERE\n"),
       "[[light]] 'lamp' has both 'radiance' and 'flux'; expected exactly one"},
      {"LightRadianceNan", Light(kSized + "radiance = nan #HERE\n"),
       "'radiance' in [[light]] 'lamp' is nan, not a finite number; expected a positive number, at most "
       "1e12"},
      {"LightRadianceNegative", Light(kSized + "radiance = [1, -1, 1] #HERE\n"),
       "'radiance[1]' in [[light]] 'lamp' is -1; expected a positive number, at most 1e12"},
      {"LightRadianceZero", Light(kSized + "radiance = 0 #HERE\n"),
       "[[light]] 'lamp' emits nothing; expected a positive number, at most 1e12"},
      {"LightRadianceAbsurd", Light(kSized + "radiance = 2e12 #HERE\n"),
       "'radiance' in [[light]] 'lamp' is 2000000000000; expected a positive number, at most 1e12"},
      {"LightFluxAbsurd", Light(kSized + "flux = 1e20 #HERE\n"),
       "flux makes a radiance of 6.37e+19 over 0.5 m²; expected at most 1e12"},
      {"LightColorBlack", Light(kSized + "color = [0, 0, 0] #HERE\nradiance = 1\n"),
       "the light's color is black; expected numbers from 0 to 1e6, not all zero"},
      {"LightColorBesideNumbers", Light(kSized + "color = [1, 0, 0] #HERE\nradiance = [1, 1, 1]\n"),
       "'color' stands beside three numbers of 'radiance'; expected one or the other"},
      {"LuminanceInRadiometricScene", Light(kSized + "luminance = 1000 #HERE\n"),
       "'luminance' is a photometric quantity and this scene's units are radiometric; expected 'radiance' or "
       "'flux'"},
      {"RadianceInPhotometricScene", "units = \"photometric\"\n" + Light(kSized + "radiance = 1000 #HERE\n"),
       "'radiance' is a radiometric quantity and this scene's units are photometric; expected 'luminance' or "
       "'luminous_flux'"},
      {"FluxInPhotometricScene", "units = \"photometric\"\n" + Light(kSized + "flux = 1000 #HERE\n"),
       "'flux' is a radiometric quantity and this scene's units are photometric; expected 'luminance' or "
       "'luminous_flux'"},
      {"NewlineInKey", "\"a\\nb\" = 1 #HERE\n" + kCamera,
       "unknown key 'a b' in the scene; expected one of: units, exposure, brdf, diffuse, aperture, sky, camera, material, surface, light"},
      {"PackageFileMissing",
       Surface("type = \"mesh\"\nfile = \"glmark2-data:models/teapot.obj\" #HERE\nmaterial = \"grey\"\n"),
       "no file 'models/teapot.obj'; expected a file in the Debian package glmark2-data"},
  };
}

class BadSceneTest : public SceneFolder, public ::testing::WithParamInterface<BadScene> {
 protected:
  // Files that some of the scenes name.
  void SetUp() override {
    Write("not_an_image.png", "these are words");
    Write("red.ppm", "P3 1 1 255 255 0 0\n");
    Write("black.ppm", "P3 1 1 255 0 0 0\n");
    WriteImage("negative.exr", {1.0f, -1.0f});
    WriteImage("nan.exr", {1.0f, NAN});
    Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    Write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    Write("inf.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 "
          "2\n");
    Write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    Write("broken.gltf", "{\"asset\":");
    Write("words.txt", "words");
    std::ofstream(outside_ / "secret.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(outside_ / "secret.png") << "secret";
    std::filesystem::create_symlink(outside_ / "secret.png", folder_ / "link.png");
    std::filesystem::create_directory_symlink(outside_, folder_ / "way_out");
    std::ofstream(outside_ / "secret.bin") << std::string(36, '\0');
    Write("buffer_outside.gltf",
          R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"../secret.bin"}]})");
  }
};

TEST_P(BadSceneTest, IsRefusedWithItsLine) {
  const BadScene& bad = GetParam();
  const std::size_t mark = bad.text.find("#HERE");
  ASSERT_NE(mark, std::string::npos);
  const auto line =
      1 + std::count(bad.text.begin(), bad.text.begin() + static_cast<std::ptrdiff_t>(mark), '\n');
  const std::string error = Error(bad.text);
  EXPECT_EQ(error, fmt::format("{}:{}: {}", (folder_ / "test.toml").string(), line, bad.message));
  EXPECT_EQ(error.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BadSceneTest, ::testing::ValuesIn(BadScenes()),
                         [](const auto& test) { return std::string(test.param.name); });

class BadSceneFile : public SceneFolder {};

TEST_F(BadSceneFile, TheBaseOfTheseTestsIsSound) {
  EXPECT_EQ(Error(kCamera + kMaterial + kSurface + kLight), "");
  EXPECT_EQ(Error(Light(kSized + "radiance = 1.0\n")), "");
  EXPECT_EQ(Error(Repeat(256, "")), "");
}

TEST_F(BadSceneFile, MissingFileAndFolderAreNamed) {
  for (const std::filesystem::path& file : {folder_ / "nothing.toml", folder_}) {
    try {
      LoadScene(file);
      FAIL() << file;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), file.string() + ": cannot be read; expected a scene file (TOML)");
    }
  }
}

// Random damage must end in a scene or in one line that names the file, never otherwise.
TEST_F(BadSceneFile, DamagedTextNeverCrashes) {
  const std::string sound = "# Is it?\nunits = \"radiometric\"\n" + kCamera + kMaterial + kSurface + kLight;
  const std::string file = (folder_ / "test.toml").string();
  std::uint32_t state = 1;  // numerical recipes' linear congruence: the same damage every time
  const auto random = [&](std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>(state >> 8) % below;
  };
  for (int round = 0; round < 500; ++round) {
    std::string text = sound;
    const std::size_t at = random(text.size());
    switch (random(3)) {
      case 0:
        text[at] = static_cast<char>(random(256));
        break;
      case 1:
        text.erase(at, 1 + random(12));
        break;
      default:
        text.resize(at);
    }
    const std::string error = Error(text);
    if (error.empty()) continue;
    EXPECT_EQ(error.rfind(file + ":", 0), 0u) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_NE(error.find("; expected "), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace arealab::bad_scene_test
