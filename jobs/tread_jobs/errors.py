"""What goes wrong, by whose fault. Exit codes are those of `tread`."""


class CampaignError(Exception):
    """The campaign file, the arguments or the campaign's directory are wrong; nothing was written."""

    exit_code = 2


class MachineError(Exception):
    """The machine cannot do it: a program is missing or refuses."""

    exit_code = 4
