# SPDX-License-Identifier: Apache-2.0
"""Prints as JSON what a ROS bag says about machines.

Messages are decoded with the definitions of ROS 2 Humble that rosbags ships, and descriptions with
ROS's own parser of URDF: nothing of Navvy's is used.
"""

import json
import pathlib
import sys

import numpy as np
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from urdf_parser_py.urdf import URDF


def matrix(translation, rotation):
    """Returns the 4 x 4 matrix of a translation and a quaternion."""
    x, y, z, w = rotation.x, rotation.y, rotation.z, rotation.w
    out = np.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, 3] = [translation.x, translation.y, translation.z]
    return out


def turn(axis, angle):
    """Returns the 4 x 4 matrix of a rotation about a unit vector."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    out = np.eye(4)
    out[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return out


def origin(element):
    """Returns the 4 x 4 matrix of an <origin>."""
    out = np.eye(4)
    if element is None:
        return out
    roll, pitch, yaw = element.rpy or [0, 0, 0]
    out = turn([0, 0, 1], yaw) @ turn([0, 1, 0], pitch) @ turn([1, 0, 0], roll)
    out[:3, 3] = element.xyz or [0, 0, 0]
    return out


def last_messages(path):
    """Returns by topic the last message, the number of messages and the offered durability."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    out = {}
    with Reader(pathlib.Path(path)) as reader:
        for connection, _, raw in reader.messages():
            if connection.msgtype not in store.fielddefs:
                continue
            topic = out.setdefault(connection.topic, {"count": 0})
            topic["count"] += 1
            topic["message"] = store.deserialize_cdr(raw, connection.msgtype)
            qos = connection.ext.offered_qos_profiles
            topic["durability"] = qos[0].durability.name if qos else ""
    return out


def tree_of(topics):
    """Returns the transforms of all frames to their parents, and checks that each has one."""
    tree = {}
    for topic in ("/tf_static", "/tf"):
        for t in topics[topic]["message"].transforms:
            assert t.child_frame_id not in tree, t.child_frame_id
            at = matrix(t.transform.translation, t.transform.rotation)
            tree[t.child_frame_id] = (t.header.frame_id, at)
    return tree


def in_map(tree, frame):
    """Returns the pose of a frame in the frame map, along its chain of parents."""
    out = np.eye(4)
    while frame != "map":
        frame, at = tree[frame]
        out = at @ out
    return out


def chains(robot, joints, tree, machine):
    """Returns the pose of each link of a URDF in its root, with the positions of its joints."""
    place = dict(zip(joints.name, joints.position))
    poses = {robot.get_root(): np.eye(4)}
    waiting = list(robot.joints)
    while waiting:
        joint = waiting.pop(0)
        if joint.parent not in poses:
            waiting.append(joint)
            continue
        at = origin(joint.origin)
        if joint.type in ("revolute", "continuous"):
            at = at @ turn(joint.axis, place[joint.name])
        elif joint.type == "prismatic":
            at[:3, 3] += at[:3, :3] @ (np.array(joint.axis) * place[joint.name])
        elif joint.type == "floating":
            at = tree[f"{machine}/{joint.child}"][1]
        else:
            assert joint.type == "fixed", joint.type
        poses[joint.child] = poses[joint.parent] @ at
    return {name: at.flatten().tolist() for name, at in poses.items()}


def shapes(elements):
    """Returns kind, size and pose of visuals or collisions."""
    out = []
    for element in elements:
        about = {k: v for k, v in vars(element.geometry).items() if v is not None}
        kind = type(element.geometry).__name__
        out.append([kind, about, origin(element.origin).flatten().tolist()])
    return out


def described(robot):
    """Returns the bodies and joints of a URDF."""
    links, joints = {}, {}
    for link in robot.links:
        body = link.inertial
        about = {"visuals": shapes(link.visuals), "collisions": shapes(link.collisions)}
        if body is not None:
            i = body.inertia
            about["mass"] = body.mass
            about["centre"] = body.origin.xyz
            about["inertia"] = [i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz]
        links[link.name] = about
    for joint in robot.joints:
        limit = joint.limit
        joints[joint.name] = {
            "type": joint.type,
            "axis": joint.axis,
            "limit": limit and [limit.lower, limit.upper, limit.effort, limit.velocity],
        }
    return {"links": links, "joints": joints, "root": robot.get_root()}


def state(message):
    """Returns frames, pose and twist of an odometry message."""
    v, w = message.twist.twist.linear, message.twist.twist.angular
    at = matrix(message.pose.pose.position, message.pose.pose.orientation)
    return {
        "frames": [message.header.frame_id, message.child_frame_id],
        "pose": at.flatten().tolist(),
        "twist": [v.x, v.y, v.z, w.x, w.y, w.z],
    }


def main():
    topics = last_messages(sys.argv[1])
    tree = tree_of(topics)
    out = {
        "topics": {k: [v["count"], v["durability"]] for k, v in topics.items()},
        "parents": {frame: parent for frame, (parent, _) in tree.items()},
        "poses": {frame: in_map(tree, frame).flatten().tolist() for frame in tree},
        "machines": {},
    }
    for machine in sys.argv[2:]:
        text = topics[f"/{machine}/robot_description"]["message"].data
        robot = URDF.from_xml_string(text.encode())
        joints = topics[f"/{machine}/joint_states"]["message"]
        out["machines"][machine] = described(robot) | {
            "poses": chains(robot, joints, tree, machine),
            "odom": state(topics[f"/{machine}/odom"]["message"]),
            "truth": state(topics[f"/{machine}/ground_truth"]["message"]),
            "states": list(joints.name),
        }
    print(json.dumps(out))


main()
