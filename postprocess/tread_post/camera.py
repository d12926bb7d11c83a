"""Where a picture is taken from, and what has to fit into it."""

import numpy as np

from tread_post.geometry import rotated

# Towards the camera. "oblique": from behind, from the right-hand side and from above, for a wheel that drives along +x: its rut lies open.
VIEWS = {"oblique": (-0.62, -1.0, 0.72), "side": (0.0, -1.0, 0.0), "front": (1.0, 0.0, 0.0), "top": (0.0, 0.0, 1.0)}
VIEW_ANGLE = 24.0
# Of the picture's width and height, left free for the drawing: right of it stands the scale, over it the title.
FRAME = ((0.03, 0.87), (0.03, 0.90))
CORNERS = np.array([(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
# Of the radius of a body that the camera follows: what is shown around its centre, low and high.
AROUND = np.array(((-1.5, -1.1, -1.1), (1.5, 1.1, 1.0)))


def box_of(low, high):
    """Corners, [8, 3]."""
    return low + CORNERS * (high - low)


def outline(points, bodies, shapes):
    """Points, [n, 3], that the picture has to hold: corners of the sand's box and of every body's."""
    parts = []
    if points is not None and len(points.position):
        parts.append(box_of(points.position.min(axis=0), points.position.max(axis=0)))
    if bodies is not None:
        boxes = np.array([(shape.vertices.min(axis=0), shape.vertices.max(axis=0)) for shape in shapes])[bodies.shape]
        local = boxes[:, None, 0] + CORNERS * (boxes[:, None, 1] - boxes[:, None, 0])
        turned = rotated(bodies.orientation, local * bodies.scale[:, None, None])
        parts.append((bodies.position[:, None] + turned).reshape(-1, 3))
    return np.concatenate(parts)


def around(bodies, row, shapes):
    """Points, [8, 3], that a picture has to hold which follows the body of a row."""
    radius = bodies.scale[row] * np.linalg.norm(shapes[bodies.shape[row]].vertices, axis=1).max()
    return box_of(*(bodies.position[row] + radius * AROUND))


def aim(renderer, content, size, view, frame=FRAME):
    """Turns the camera to the drawing from one of VIEWS, and fits the points `content` into a frame: shares of the width and of the height."""
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*VIEWS[view])
    camera.SetFocalPoint(0.0, 0.0, 0.0)
    camera.SetViewUp(*((0.0, 1.0, 0.0) if view == "top" else (0.0, 0.0, 1.0)))
    camera.SetViewAngle(VIEW_ANGLE)
    low, high = content.min(axis=0), content.max(axis=0)
    renderer.ResetCamera(*np.stack((low, high), axis=1).ravel())

    seen = seen_from(renderer, content, size)[:, :2]
    low, high = seen.min(axis=0), seen.max(axis=0)
    frame = 2 * np.array(frame) - 1
    zoom = ((frame[:, 1] - frame[:, 0]) / (high - low)).min()
    camera.Zoom(zoom)
    camera.SetWindowCenter(*(zoom * 0.5 * (low + high) - frame.mean(axis=1)))
    renderer.ResetCameraClippingRange()


def seen_from(renderer, places, size):
    """Where the camera sees places [n, 3] (m): -1 to 1 across and up the picture, and their depth, [n, 3]."""
    matrix = renderer.GetActiveCamera().GetCompositeProjectionTransformMatrix(size[0] / size[1], -1.0, 1.0)
    projection = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    seen = np.column_stack((places, np.ones(len(places)))) @ projection.T
    return seen[:, :3] / seen[:, 3:]
