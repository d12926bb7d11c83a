"""The pages of `tread watch`. They read runs and campaigns and write nothing."""
