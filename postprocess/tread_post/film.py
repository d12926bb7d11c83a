"""Pictures put together to a film: an animated GIF, or H.264 in MP4 by ffmpeg."""

import shutil
import subprocess

from tread_post.run import RunError

LAST_FRAME = 1.0  # s for which the last picture stands
SUFFIXES = (".gif", ".mp4")


def require_writer(output):
    """RunError if no film can be written to `output`: another suffix, or an MP4 without ffmpeg."""
    if output.suffix not in SUFFIXES:
        raise RunError(f"--output {output}: a film is written as {' or '.join(SUFFIXES)}")
    if output.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise RunError(f"--output {output}: MP4 wants ffmpeg (Debian's package of that name); .gif does not")


def write_film(frames, output, fps):
    """Writes pictures, paths of PNG of one size, as a film of `fps` pictures a second."""
    (_write_mp4 if output.suffix == ".mp4" else _write_gif)(frames, output, fps)


def _write_gif(frames, output, fps):
    from PIL import Image

    pictures = [Image.open(frame).convert("RGB").quantize(128) for frame in frames]
    times = [round(1000 / fps)] * (len(frames) - 1) + [round(1000 * LAST_FRAME)]
    pictures[0].save(output, save_all=True, append_images=pictures[1:], duration=times, loop=0)


def _write_mp4(frames, output, fps):
    """Players want an even number of pixels, and 4:2:0."""
    held = max(1, round(fps * LAST_FRAME))
    pictures = b"".join(frame.read_bytes() for frame in [*frames, *[frames[-1]] * (held - 1)])
    command = ["ffmpeg", "-loglevel", "error", "-y", "-f", "image2pipe", "-framerate", str(fps), "-i", "-", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2",
               "-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(output)]
    done = subprocess.run(command, input=pictures, capture_output=True)
    if done.returncode != 0:
        raise RunError(f"{output}: ffmpeg: {done.stderr.decode(errors='replace').strip()}")
