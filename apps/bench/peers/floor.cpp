// Loads OpenVDB and ends: the cost of every program that uses the library, before any work.

#include <openvdb/openvdb.h>

int main() {
  openvdb::initialize();
}
