// Every mistake is named with its line, and with what to do.
#include <gtest/gtest.h>

#include "tests/master/script/script_support.h"

namespace rayfarm {
namespace {

/// The complaint about line 2.
std::string about(const std::string& line) { return complaint("\n" + line); }

TEST(Complaints, NameTheLineOfASyntaxError) {
  EXPECT_EQ(complaint("local a = 1\nlocal b = = 2"), "test.lua:2: unexpected symbol near '='");
  EXPECT_EQ(complaint("return scene{\n  root = sphere{}\n"),
            "test.lua:3: '}' expected (to close '{' at line 1) near <eof>");
  EXPECT_NE(complaint(std::string("\x1bLua", 4)).find("attempt to load a binary chunk"), std::string::npos);
}

TEST(Complaints, SuggestTheNameThatWasMeant) {
  EXPECT_EQ(about("spere{}"), "test.lua:2: unknown name 'spere', did you mean 'sphere'?");
  EXPECT_EQ(about("local s = Sphere{}"), "test.lua:2: unknown name 'Sphere', did you mean 'sphere'?");
  EXPECT_EQ(about("hyperboloid{}"), "test.lua:2: unknown name 'hyperboloid'");
  EXPECT_EQ(about("sphere{}:rotatex(3)"),
            "test.lua:2: a node has no method 'rotatex', did you mean 'rotate_x'?");
  EXPECT_EQ(about("sphere{}:colour(1)"), "test.lua:2: a node has no method 'colour', did you mean 'color'?");
  EXPECT_EQ(about("phong{ difuse = 1 }"), "test.lua:2: phong: unknown key 'difuse', did you mean 'diffuse'?");
  EXPECT_EQ(about("point{ at = {0,0,0}, color = 1 }"),
            "test.lua:2: point: unknown key 'color', there are: at intensity");
  EXPECT_EQ(about("sphere{ radius = 2 }"), "test.lua:2: sphere: unknown key 'radius', there are none");
  EXPECT_EQ(about("sphere{ 2 }"), "test.lua:2: sphere: value number 1 has no meaning here, give it a key");
  EXPECT_EQ(about("return scene{ root = sphere{}, image = { witdh = 2 } }"),
            "test.lua:2: image: unknown key 'witdh', did you mean 'width'?");
}

TEST(Complaints, NameTheFunctionAndWhatItWants) {
  EXPECT_EQ(about("torus{ 1, -1 }"), "test.lua:2: torus: r must be positive, is -1");
  EXPECT_EQ(about("rounded_cube{ 0.6 }"), "test.lua:2: rounded_cube: r must be at most 0.5, is 0.6");
  EXPECT_EQ(about("torus{ R = 0 }"), "test.lua:2: torus: R must be positive, is 0");
  EXPECT_EQ(about("torus{ 1, r = 2, R = 1 }"),
            "test.lua:2: torus: R is given twice, by name and by position");
  EXPECT_EQ(about("torus{ '1' }"), "test.lua:2: torus: R must be a number, is the string '1'");
  EXPECT_EQ(about("torus(1, 2)"), "test.lua:2: torus: expects a table, write torus{ ... }; got the number 1");
  EXPECT_EQ(about("cylinder{ 1, 1 }"), "test.lua:2: cylinder: zmin must be below zmax");
  EXPECT_EQ(about("checker{ 1, 1, {1, 1} }"),
            "test.lua:2: checker: color must be {r, g, b} or a number, has 2 numbers");
  EXPECT_EQ(about("phong{ exponent = 1.5 }"), "test.lua:2: phong: exponent must be a whole number, is 1.5");
  EXPECT_EQ(about("phong{ ambient = -1 }"), "test.lua:2: phong: ambient must not be negative, is -1");
  EXPECT_EQ(about("phong{ index = 0 }"), "test.lua:2: phong: index must be positive, is 0");
  EXPECT_EQ(about("ambient()"), "test.lua:2: ambient: the intensity must be {r, g, b} or a number, is nil");
  EXPECT_EQ(about("point{}"), "test.lua:2: point: at is missing");
  EXPECT_EQ(about("perspective{ angle = 180 }"),
            "test.lua:2: perspective: angle must be above 0 and below 180 degrees");
  EXPECT_EQ(about("fisheye{ angle = 361 }"),
            "test.lua:2: fisheye: angle must be above 0 and at most 360 degrees");
  EXPECT_EQ(about("parabolic{ radius = 0 }"), "test.lua:2: parabolic: radius must be positive, is 0");
  EXPECT_EQ(about("orthographic{ width = -1 }"), "test.lua:2: orthographic: width must be positive, is -1");
  EXPECT_EQ(about("glow_cylinder{ 1, 1 }"), "test.lua:2: glow_cylinder: zmin must be below zmax");
  EXPECT_EQ(about("sphere{}:no_shadow(true)"), "test.lua:2: no_shadow: takes nothing, got 1 values");
  EXPECT_EQ(
      about("return scene{ root = difference{ sphere{}, glow_sphere{} } }"),
      "test.lua:2: node 2 (glow sphere): a glow shell has no inside that could be cut or cut away, put it "
      "in unions only");
  EXPECT_EQ(about("rectangle{ at = {0,0,0}, width = {1,0,0}, height = {0,1,0}, dim = {0,0,0} }"),
            "test.lua:2: rectangle: dim must not be all zeros, {1, 0, 0} means no dimming");
}

TEST(Complaints, RefuseNumbersThatAreNone) {
  EXPECT_EQ(about("torus{ 0/0, 1 }"), "test.lua:2: torus: R must be a finite number, is nan");
  EXPECT_EQ(about("torus{ math.huge, 1 }"), "test.lua:2: torus: R must be a finite number, is inf");
  EXPECT_EQ(about("sphere{}:translate(0, 0/0, 0)"),
            "test.lua:2: translate: y must be a finite number, is nan");
  EXPECT_EQ(about("sphere{}:rotate_x(math.huge)"),
            "test.lua:2: rotate_x: the angle must be a finite number, is inf");
  EXPECT_EQ(about("return scene{ root = sphere{}:translate(1e308, 0, 0):translate(1e308, 0, 0) }"),
            "test.lua:2: node 0 (sphere): its transform cannot be inverted: no scale may be 0, no number "
            "infinite or out of "
            "proportion");
}

TEST(Complaints, NameTheMethodAndWhatItTakes) {
  EXPECT_EQ(about("sphere{}:translate(1, 2)"), "test.lua:2: translate: z must be a number, is nil");
  EXPECT_EQ(about("sphere{}:translate(1, 2, 3, 4)"),
            "test.lua:2: translate: takes three numbers or {x, y, z}, got 4 values");
  EXPECT_EQ(about("sphere{}:translate({1, 2})"), "test.lua:2: translate must be {x, y, z}, has 2 numbers");
  EXPECT_EQ(about("sphere{}:scale(0)"),
            "test.lua:2: scale: a factor of 0 makes the node flat, it must not be 0");
  EXPECT_EQ(about("sphere{}:rotate_y()"),
            "test.lua:2: rotate_y: takes one number, the angle in degrees, got 0 values");
  EXPECT_EQ(about("sphere{}:rotate({0, 0, 0}, 5)"), "test.lua:2: rotate: the axis must not be {0, 0, 0}");
  EXPECT_EQ(about("sphere{}:matrix{ {1, 0, 0, 0}, {2, 0, 0, 0}, {0, 0, 1, 0} }"),
            "test.lua:2: matrix: cannot be inverted, its columns must span space");
  EXPECT_EQ(
      about("sphere{}:matrix{ 1, 2, 3 }"),
      "test.lua:2: matrix: takes three rows of four numbers, { {a, b, c, d}, {e, f, g, h}, {i, j, k, l} }");
  EXPECT_EQ(about("sphere{}:material{ color = 1 }"),
            "test.lua:2: material: its argument must be a material, is a table");
  EXPECT_EQ(about("sphere{}:texture(phong{})"),
            "test.lua:2: texture: argument 1 must be a texture, is a material");
  EXPECT_EQ(about("sphere{}:color('red')"),
            "test.lua:2: color must be {r, g, b} or a number, is the string 'red'");
  EXPECT_EQ(about("sphere{}.scale(2)"),
            "test.lua:2: scale: call it on a node with a colon, node:scale(...); got the number 2");
}

TEST(Complaints, FindTheHoleInAList) {
  EXPECT_EQ(about("union{}"), "test.lua:2: union: the list is empty, it needs at least one node");
  EXPECT_EQ(about("union()"), "test.lua:2: union: expects a list of nodes, write union{ a, b }; got nil");
  EXPECT_EQ(about("union{ sphere{}, 3 }"), "test.lua:2: union: entry 2 must be a node, is the number 3");
  EXPECT_EQ(about("union{ nil, sphere{} }"), "test.lua:2: union: the list has holes, is an entry nil?");
  EXPECT_EQ(about("xor{ sphere{}, a = cube{} }"),
            "test.lua:2: xor: unknown key 'a', it takes a list of nodes only");
  EXPECT_EQ(about("return scene{ root = sphere{}, lights = { 0.5 } }"),
            "test.lua:2: scene: lights: entry 1 must be a light, is the number 0.5");
  EXPECT_EQ(
      about("return scene{ root = sphere{}, lights = { ambient(1), nil, ambient(1), nil } }").substr(0, 25),
      "test.lua:2: scene: lights");
}

TEST(Complaints, WantASceneAtTheEnd) {
  EXPECT_EQ(complaint(""), "test.lua: the script must end with return scene{ ... }, it returns nil");
  EXPECT_EQ(complaint("return sphere{}"),
            "test.lua: the script must end with return scene{ ... }, it returns a node");
  EXPECT_EQ(complaint("scene{ root = sphere{} }"),
            "test.lua: the script must end with return scene{ ... }, it returns nil");
  EXPECT_EQ(about("return scene{}"), "test.lua:2: scene: root is missing");
  EXPECT_EQ(about("return scene{ root = { sphere{} } }"),
            "test.lua:2: scene: root must be a node, is a table");
  EXPECT_EQ(about("return scene{ root = sphere{}, camera = {} }"),
            "test.lua:2: scene: camera must be a camera, is a table");
  EXPECT_EQ(about("return scene{ root = sphere{}, image = { width = 0 } }"),
            "test.lua:2: image: width must be at least 1, is 0");
  EXPECT_EQ(about("return scene{ root = sphere{}, image = { height = 1000000 } }"),
            "test.lua:2: image: height must be at most 60000, is 1000000");
  EXPECT_EQ(about("return scene{ root = sphere{}, camera = perspective{ direction = {0, 1, 0} } }"),
            "test.lua:2: camera: direction must not be parallel to up, give another up such as {0, 0, 1}");
  EXPECT_EQ(about("local s = scene{ root = sphere{} } return scene{ root = sphere{} }"),
            "test.lua:2: scene: may be called only once in a script");
}

TEST(Complaints, CarryTheScriptsOwnErrors) {
  EXPECT_EQ(about("error('no such mode')"), "test.lua:2: no such mode");
  EXPECT_EQ(about("error({})"), "test.lua: the error is a table");
  EXPECT_EQ(about("local t = {} t.x.y = 1"), "test.lua:2: attempt to index a nil value (field 'x')");
}

TEST(Complaints, RefuseATreeThatWouldBeTooLarge) {
  // Doubling thirty times is cheap to write down, sharing its parts; spread out it has 10^9 nodes.
  EXPECT_EQ(complaint("local a = sphere{}\nfor i = 1, 30 do\na = union{ a, a } end"),
            "test.lua:3: union: the tree has more than 8000000 nodes (a node used twice counts twice)");
  EXPECT_EQ(complaint("local a = sphere{}\nfor i = 1, 300 do\na = union{ a } end"),
            "test.lua:3: union: the tree is more than 256 levels deep");
}

}  // namespace
}  // namespace rayfarm
