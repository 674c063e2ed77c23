// Loads OpenVDB and ends: what every program that uses the library costs before it does anything.

#include <openvdb/openvdb.h>

int main() {
  openvdb::initialize();
}
