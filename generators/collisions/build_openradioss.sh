#!/bin/bash
# Builds the OpenRadioss starter and engine (one process, double precision, gfortran) from its public source.
#
#   git clone https://github.com/OpenRadioss/OpenRadioss
#   generators/collisions/build_openradioss.sh OpenRadioss [JOBS]
#
# Executables: OpenRadioss/exec/starter_linux64_gf, OpenRadioss/exec/engine_linux64_gf_smp.
#
# The project's own build downloads binary libraries that decks without H3D output do not need. Here the
# distribution's libraries stand in for them (Debian and Ubuntu: gfortran cmake libmetis-dev liblapack-dev
# zlib1g-dev libmd-dev libboost-dev libboost-filesystem-dev), and exprtk, one header, is taken from
# EXPRTK=FILE or downloaded. About 40 minutes on two cores.
set -euo pipefail

source_folder=$(realpath "${1:?the folder of the OpenRadioss source}")
jobs=${2:-$(nproc)}
libraries=/usr/lib/$(gcc -print-multiarch)
cd "$source_folder"

for needed in "$libraries"/{libz.a,libmd.a,libmetis.so,libboost_filesystem.so,lapack/liblapack.a,blas/libblas.a} \
              /usr/include/{zlib.h,md5.h,boost/version.hpp}; do
  [ -e "$needed" ] || { echo "$needed is not there: install the packages that this script names" >&2; exit 1; }
done

external=extlib
mkdir -p $external/{zlib/linux64/include,zlib/linux64/lib,lapack-3.10.0/lib_linux64_gf,metis/linux64} \
         $external/{md5/include,md5/linux64,h3d/includes,exprtk,license,boost/boost_1_70_0}
cp /usr/include/zlib.h $external/zlib/linux64/include/
find /usr/include -name zconf.h -exec cp {} $external/zlib/linux64/include/ \;
cp "$libraries/libz.a" $external/zlib/linux64/lib/
cp "$libraries/lapack/liblapack.a" $external/lapack-3.10.0/lib_linux64_gf/
cp "$libraries/blas/libblas.a" $external/lapack-3.10.0/lib_linux64_gf/librefblas.a
ar cr $external/lapack-3.10.0/lib_linux64_gf/libtmglib.a
ln -sfn /usr/include/boost $external/boost/boost_1_70_0/boost
if [ -n "${EXPRTK:-}" ]; then
  cp "$EXPRTK" $external/exprtk/exprtk.hpp
elif [ ! -s $external/exprtk/exprtk.hpp ]; then
  curl -fsSL -o $external/exprtk/exprtk.hpp \
    https://raw.githubusercontent.com/ArashPartow/exprtk/master/exprtk.hpp
fi
# libmd has the interface of the MD5 library that the checksums of a model use.
{ echo '#define LIBMD_MD5_ALADDIN'; cat /usr/include/md5.h; } > $external/md5/include/md5.h
cp "$libraries/libmd.a" $external/md5/linux64/libmd5.a
# Tells the build that its downloads are there.
cp EXTLIB_VERSION.json $external/
touch $external/license/hm_reader_license.txt

# H3D output needs a library that is not public: its files are left out, and what calls them is not reached
# by a deck without /H3D.
rm -rf engine/source/output/h3d/h3d_build_cpp
sed -i 's|\${open_reader_root_dir}/../extlib/boost/[^)]*libboost_filesystem.\${lib}|boost_filesystem|' reader/CMakeLists.txt
# The reader of the same source does not know the newest input format that the starter asks for, nor four
# functions that only rigid parts and ALE meshes need.
sed -i 's|^    sUserProfileLoadedVersion = version;|    sUserProfileLoadedVersion = version > 2026 ? 2026 : version;|' \
  reader/source/io/model_readers/radioss/radiossblk/radiossblk.cxx
formats=hm_cfg_files/config/CFG
if [ -d $formats/radioss2612 ]; then
  cp -rn $formats/radioss2612/* $formats/radioss2026/
  find $formats/radioss2026 -name '*.cfg' -exec sed -i 's/radioss2612/radioss2026/g' {} +
fi
cat > starter/source/devtools/hm_reader/not_in_open_reader.c <<'SOURCE'
#include <stdbool.h>
void cpp_evaluate_rbodies_number_from_rigid_parts_(int *count) { *count = 0; }
void cpp_create_rbodies_from_rigid_parts_(int *part, int *body) { (void)part; (void)body; }
void cpp_is_part_with_elements_(const int *part, bool *has_elements) { (void)part; *has_elements = true; }
void cpp_sale_mesh_create_(int *message) { (void)message; }
SOURCE
for part in starter engine; do
  settings=$part/CMake_Compilers/cmake_linux64_gf.txt
  sed -i -e 's|^set *(metis_lib .*|set (metis_lib "-lmetis")|' \
         -e 's|^\( *set *(LINK *"[a-z]*\) |\1 -Wl,--unresolved-symbols=ignore-all |' $settings
done

(cd starter && ./build_script.sh -arch=linux64_gf -prec=dp -open_reader -nt="$jobs")
(cd engine && ./build_script.sh -arch=linux64_gf -prec=dp -mpi=smp -nt="$jobs")
