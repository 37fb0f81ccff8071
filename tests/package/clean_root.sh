#!/bin/sh
# usage: clean_root.sh BUILD ROOT
# Makes the packages of a build tree, then a root that holds what the package declares and nothing else (the files of the packages it depends on, taken from
# this machine's, and of those that they depend on), installs the command's package there by dpkg, and runs the command as it then
# lies there: with the loader and the libraries of that root.
set -eu
build=$1
root=$2
for tool in dpkg-shlibdeps dpkg-deb file objdump; do
    command -v $tool >/dev/null || { echo "not judged: $tool is not installed"; exit 0; }
done
rm -rf "$root"
mkdir -p "$root/packages" "$root/var/lib/dpkg/info" "$root/var/lib/dpkg/updates"
root=$(realpath "$root")
: >"$root/var/lib/dpkg/status"

cpack --config "$build/CPackConfig.cmake" -B "$root/packages" >/dev/null
deb=$(find "$root/packages" -maxdepth 1 -name 'elastocheck_*.deb')
find "$root/packages" -maxdepth 1 -name 'libelastocheck-dev_*.deb' | grep -q .

# The names in a list of dependencies, of alternatives the first that is installed here, "a (>= 1), b | c".
chosen() {
    printf '%s\n' "$1" | tr ',' '\n' | while IFS= read -r choice; do
        printf '%s\n' "$choice" | tr '|' '\n' | sed 's/([^)]*)//; s/:any//; s/ //g' | while IFS= read -r name; do
            if dpkg-query -W -f='${Status}\n' "$name" 2>/dev/null | grep -q 'ok installed'; then
                echo "$name"
                break
            fi
        done
    done
}

depends=$(dpkg-deb -f "$deb" Depends)
waiting=$(chosen "$depends")
declared=$waiting
closure=' '
while [ -n "$waiting" ]; do
    more=''
    for package in $waiting; do
        case $closure in *" $package "*) continue ;; esac
        closure="$closure$package "
        more="$more $(chosen "$(dpkg-query -W -f='${Pre-Depends}, ${Depends}' "$package")")"
    done
    waiting=$(echo "$more" | tr ' ' '\n' | sort -u)
done

for package in $closure; do
    dpkg-query -s "$package" >>"$root/var/lib/dpkg/status"
    echo >>"$root/var/lib/dpkg/status"
    : >"$root/var/lib/dpkg/info/$(dpkg-query -W -f='${binary:Package}' "$package").list"
    # Libraries and the loader: what a program needs to start. A folder that is a link elsewhere (/lib) is one here.
    dpkg-query -L "$package" | grep -E '/[^/]*\.so(\.[^/]*)?$' | while IFS= read -r file; do
        [ -f "$file" ] || continue
        place=$(realpath "$(dirname "$file")")
        mkdir -p "$root$place"
        cp -L "$file" "$root$place/"
    done
done

dpkg --root="$root" --force-not-root --force-bad-path --log=/dev/null -i "$deb" >/dev/null
program=$root/usr/bin/elastocheck

# What is linked with is declared itself, not only by others.
objdump -p "$program" | awk '/NEEDED/ {print $2}' | while IFS= read -r library; do
    of=''
    for package in $declared; do
        if dpkg-query -L "$package" | sed 's|.*/||' | grep -qxF "$library"; then of=$package; fi
    done
    [ -n "$of" ] || { echo "$library is linked with, and no package of '$depends' has it" >&2; exit 1; }
done

loader=$(find "$root" -name 'ld-linux*.so*' | head -n 1)
path=$(find "$root" -name '*.so*' -exec dirname {} + | sort -u | tr '\n' ':')
# Every library comes from the root.
"$loader" --inhibit-cache --library-path "$path" --list "$program" >"$root/libraries"
if grep -v -e "$root" -e linux-vdso "$root/libraries" >&2; then
    echo "is not of the packages that are declared" >&2
    exit 1
fi
elastocheck() { "$loader" --inhibit-cache --library-path "$path" "$program" "$@"; }
elastocheck --version | head -n 1
elastocheck inspect "$root/usr/share/elastocheck/scenes/mcpherson.yaml" >/dev/null
(unset CI; elastocheck gate "$root/usr/share/elastocheck/scenes/pinned_bar.yaml" --class physical)  # where CI is set, nobody has reviewed that baseline

# Help names files of the root. (Not by its loader, which would be the program that is asked where it is.)
"$program" --help | sed -n 's/^[^/]*: \//\//p' >"$root/named"
[ "$(wc -l <"$root/named")" -eq 2 ]
while IFS= read -r file; do
    case $file in "$root"/usr/share/doc/elastocheck/*) ;; *) echo "--help names $file" >&2; exit 1 ;; esac
    [ -f "$file" ] || { echo "--help names $file, which is not there" >&2; exit 1; }
done <"$root/named"
