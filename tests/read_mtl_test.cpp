#include "libvox/io/read_mtl.h"

#include "libvox/core/error.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vox;

namespace {

Material only(const std::string& statements) {
  const std::vector<Material> materials = parseMtl("newmtl a\n" + statements, "folder/a.mtl");
  REQUIRE(materials.size() == 1);
  return materials[0];
}

ImageMap imageOf(const std::string& arguments) {
  const Material material = only("map_Kd " + arguments);
  REQUIRE(material.image);
  return *material.image;
}

std::string mtlRefusal(const std::string& text) {
  try {
    parseMtl(text, "a.mtl");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("materials have the names, colours, images and opacities of the file",
          "[io][mtl][golden]") {
  const auto materials = parseMtl(
      "# by hand\n"
      "newmtl red\nNs 10\nKa 1 1 1\nKd 1 0.25 0\nKs 0 0 0\nd 0.5\nillum 2\n\n"
      "newmtl with blanks \n  map_Kd wood.png\n"
      "newmtl plain\n",
      "models/a.mtl");
  REQUIRE(materials.size() == 3);
  CHECK(materials[0].name == "red");
  CHECK(materials[0].color == Vec3f(1, 0.25F, 0));  // linear, as it is written
  CHECK(materials[0].opacity == 0.5);
  CHECK_FALSE(materials[0].image);
  CHECK(materials[1].name == "with blanks");
  CHECK(materials[1].image->file == "models/wood.png");
  CHECK(materials[1].image->scale == Vec2d(1, 1));
  CHECK(materials[1].image->offset == Vec2d(0, 0));
  CHECK_FALSE(materials[1].image->clamp);
  CHECK(materials[2].color == Vec3f::Constant(kPlainColor));
  CHECK(materials[2].opacity == 1);
}

TEST_CASE("any line ends, cases, comments and byte order marks are read alike",
          "[io][mtl][golden]") {
  const std::string text = GENERATE(
      "newmtl a\nKd 0 1 0\nmap_Kd a.png\n", "newmtl a\r\nKd 0 1 0\r\nmap_Kd a.png\r\n",
      "newmtl a\rKd 0 1 0\rmap_Kd a.png", "\xEF\xBB\xBFnewmtl a\nKd 0 1 0\nmap_Kd a.png",
      "NEWMTL a\nKD 0 1 0\nMAP_KD a.png\n", "\tnewmtl\ta\n\t Kd 0  1\t0 \n map_Kd\ta.png  ",
      "newmtl a # green\nKd 0 1 0# green\nmap_Kd a.png #x\n",
      "Kd 1 1 1\nmap_Kd lost.png\nnewmtl a\nKd 0 1 0 7\nmap_Kd a.png\nmap_Kd\nunknown x y\n",
      "newmtl a\nKd 1 1 1\nKd 0 1 0\nmap_Kd b.png\nmap_Kd \"a.png\"\n",
      "newmtl a\nKd 0 1 0\nnewmtl b\nnewmtl a\nmap_Kd a.png\n",
      "newmtl a\nKd -3 9e9 -0\nmap_Kd a.png");
  CAPTURE(text);
  const auto materials = parseMtl(text, "a.mtl");
  REQUIRE(!materials.empty());
  CHECK(materials[0].name == "a");
  CHECK(materials[0].color == Vec3f(0, 1, 0));
  REQUIRE(materials[0].image);
  CHECK(materials[0].image->file == "a.png");
}

TEST_CASE("Kd with one number is grey, spectral curves are skipped", "[io][mtl][golden]") {
  CHECK(only("Kd 0.25").color == Vec3f::Constant(0.25F));
  CHECK(only("Kd spectral a.rfl 2").color == Vec3f::Constant(kPlainColor));
  CHECK(only("Kd xyz 1 2 3").color == Vec3f::Constant(kPlainColor));
}

TEST_CASE("Tr is the opposite of d", "[io][mtl][golden]") {
  CHECK(only("Tr 0.25").opacity == 0.75);
  CHECK(only("d -halo 0.25").opacity == 0.25);
  CHECK(only("d 7").opacity == 1);
}

TEST_CASE("options of images come before the file name", "[io][mtl][golden]") {
  const ImageMap all = imageOf(
      "-blendu on -blendv off -bm 1.5 -boost 2 -cc on -clamp on -imfchan r -mm 0 1 -texres 1024 "
      "-type sphere -t 1 2 3 -s 2 3 4 -o 0.5 -0.25 0 my wood.png");
  CHECK(all.file == "folder/my wood.png");
  CHECK(all.scale == Vec2d(2, 3));
  CHECK(all.offset == Vec2d(0.5, -0.25));
  CHECK(all.clamp);

  const ImageMap some = imageOf("-S 2 -O +.5 -Clamp OFF 8k.png");
  CHECK(some.file == "folder/8k.png");
  CHECK(some.scale == Vec2d(2, 1));
  CHECK(some.offset == Vec2d(0.5, 0));
  CHECK_FALSE(some.clamp);

  CHECK(imageOf("-s 2 3 -clamp on -o 1 a.png").offset == Vec2d(1, 0));
  CHECK(imageOf("-odd.png").file == "folder/-odd.png");
}

TEST_CASE("paths of images are relative to the folder of the file", "[io][mtl][golden]") {
  CHECK(imageOf("a.png").file == "folder/a.png");
  CHECK(imageOf("maps/a#1.png").file == "folder/maps/a#1.png");
  CHECK(imageOf("maps\\wood\\a b.png").file == "folder/maps/wood/a b.png");
  CHECK(imageOf("/maps/a.png").file == "/maps/a.png");
  CHECK(imageOf("C:\\maps\\a b.png").file == "folder/a b.png");
  CHECK(imageOf("c:a.png").file == "folder/a.png");
  CHECK(imageOf("\\\\server\\maps\\a.png").file == "folder/a.png");
  CHECK(imageOf("maps\\").file == "folder/maps/");
  CHECK(imageOf("C:").file == "folder/C:");  // no name is left, so all of it is for messages
}

TEST_CASE("an image that is not at its path is taken from beside the file", "[io][mtl][golden]") {
  const test::TemporaryFolder folder;
  folder.write("here.png", "x");
  const auto materials = readMtl(folder.write("a.mtl",
                                              "newmtl a\nmap_Kd /nowhere/here.png\n"
                                              "newmtl b\nmap_Kd maps/here.png\n"
                                              "newmtl c\nmap_Kd maps/there.png\n"));
  REQUIRE(materials.size() == 3);
  CHECK(materials[0].image->file == (folder / "here.png").string());
  CHECK(materials[1].image->file == (folder / "here.png").string());
  CHECK(materials[2].image->file == (folder / "maps/there.png").string());
}

TEST_CASE("names keep blanks and # inside", "[io][mtl][golden]") {
  CHECK(materialName("  Color #1") == "Color");
  CHECK(materialName(" Color_#1 b \t") == "Color_#1 b");
  CHECK(materialName(" # only") == "");
  CHECK(materialName("\"a b\"") == "a b");
  CHECK(materialName("\"") == "\"");
  CHECK(materialName("") == "");
}

TEST_CASE("malformed numbers of materials are refused by line", "[io][mtl][error]") {
  CHECK_THAT(mtlRefusal("newmtl a\nKd 1 x 0"),
             Catch::StartsWith("a.mtl:2: expected a number, found 'x'"));
  CHECK_THAT(mtlRefusal("newmtl a\nKd 1 0"), Catch::StartsWith("a.mtl:2: Kd with 2 numbers"));
  CHECK_THAT(mtlRefusal("newmtl a\nKd"), Catch::StartsWith("a.mtl:2: Kd with 0 numbers"));
  CHECK_THAT(mtlRefusal("newmtl a\n\nKd nan 0 0"),
             Catch::StartsWith("a.mtl:3: 'nan' is not a finite"));
  CHECK_THAT(mtlRefusal("newmtl a\nd"), Catch::StartsWith("a.mtl:2: expected a number"));
  CHECK_THAT(mtlRefusal("newmtl a\nTr 1,5"), Catch::StartsWith("a.mtl:2: expected a number"));
  CHECK_THAT(mtlRefusal("newmtl a\nmap_Kd -s a.png"),
             Catch::StartsWith("a.mtl:2: expected a number"));
  CHECK_THAT(mtlRefusal("newmtl a\nmap_Kd -o 1 1e999 a.png"),
             Catch::StartsWith("accepted"));  // what is no number begins the name
  CHECK_THAT(mtlRefusal(std::string("\xFF\xFEn\0", 4)),
             Catch::StartsWith("a.mtl:1: the text is UTF-16"));
}

TEST_CASE("files that cannot be read as materials are named", "[io][mtl][error]") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(readMtl(folder / "a.mtl"),
                    Catch::EndsWith("a.mtl: no such file; check the path"));
}
