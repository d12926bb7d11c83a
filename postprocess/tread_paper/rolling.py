"""A wheel that rolls without slip over the ripple of section 5, f(x) = 0.1 sin(2 pi x) + 0.1: the analytical line of the paper's Fig. 26."""

import numpy as np

# Of the scene: where the ripple's toe is, and what the flat before it is level with.
TOE, WAVELENGTH, AMPLITUDE = 0.9, 1.0, 0.1


def rolled_over(history, quantity):
    """Time (s) and speed or vertical_speed (m/s) of the centre of a wheel of the history's radius and spin, from where its drive began."""
    radius, speed = history.radius, history.spin * history.radius
    contact = np.linspace(history.wheel["position"][0, 0], TOE + WAVELENGTH + 1.0, 20001)
    place = centres(contact, radius)
    step = np.diff(place, axis=0)
    forward = step[:, 0] > 0  # in the toe the wheel touches twice; its centre does not go back
    length = np.where(forward, np.linalg.norm(step, axis=1), 0.0)
    time = np.cumsum(length) / speed
    part = {"speed": 0, "vertical_speed": 1}[quantity]
    with np.errstate(divide="ignore", invalid="ignore"):
        values = speed * step[:, part] / np.linalg.norm(step, axis=1)
    shown = forward & (time <= history.time[-1])
    return time[shown], values[shown]


def height(x):
    """m, of the ground over the flat."""
    on_ripple = (x > TOE) & (x < TOE + WAVELENGTH)
    return np.where(on_ripple, AMPLITUDE * (1 - np.cos(2 * np.pi * (x - TOE) / WAVELENGTH)), 0.0)


def centres(contact, radius):
    """[n, 2] (m): of wheels that touch the ground at `contact` [n]."""
    slope = np.gradient(height(contact), contact)
    down = np.sqrt(1 + slope**2)
    return np.stack((contact - radius * slope / down, height(contact) + radius / down), axis=1)
