#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Follows the maps of `navvy run SCENE --publish tcp:PORT`, or of a folder.

Usage: read_patches.py PORT|FOLDER
"""
import itertools, json, pathlib, socket, sys, time
import numpy


def patches(place):
    """Yields the byte streams of a run as file objects until it ends.

    A folder may still be written to."""
    if place.isdigit():
        yield socket.create_connection(('127.0.0.1', int(place))).makefile('rb')
    else:
        for number in itertools.count(1):
            path, end = pathlib.Path(place, f'patch_{number:09}.navvymap'), pathlib.Path(
                place, 'end'
            )
            # Check for the end first, so that patches written before it are still read.
            while not ((ended := end.exists()) or path.exists()):
                # nothing has changed, or no patch is due
                time.sleep(0.1)
            if ended and not path.exists():
                return
            yield open(path, 'rb')


def follow(place):
    """Yields the header of every patch and the layers after it, each [iy, ix], row 0 = least y."""
    layers, seen = {}, 0
    for stream in patches(place):
        while (magic := stream.read(8)) == b'NAVVYMAP':
            header = json.loads(stream.read(int.from_bytes(stream.read(4), 'little')))
            # A patch since 0 is the whole map; it also follows a reset of the run, with an earlier
            # time.
            assert header['since'] in (0, seen) and header['sequence'] > seen, 'a patch is missing'
            for x0, y0, x1, y1 in header['rects']:
                for name in header['layers']:
                    whole = layers.setdefault(
                        name, numpy.full((header['ny'], header['nx']), numpy.nan, 'f4')
                    )
                    part = numpy.frombuffer(stream.read(4 * (x1 - x0) * (y1 - y0)), '<f4')
                    whole[y0:y1, x0:x1] = part.reshape(y1 - y0, x1 - x0)
            seen = header['sequence']
            yield header, layers


if __name__ == '__main__':
    for header, layers in follow(sys.argv[1]):
        print(
            f"{header['time_s']:8.2f} s  patch {header['sequence']}: {header['changed']} columns"
            " changed"
        )
