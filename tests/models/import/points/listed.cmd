! Own example: points alone, in metres, each in the frame that it names.
defaults units length = meter angle = rad
marker create marker_name = .car.ground.turned location = 1.0, 0.0, 0.0 orientation = 1.5707963267948966, 0, 0
point create point_name = .car.ground.arm_outer location = 0.5, 0.25, 0.1 relative_to = .car.ground
point create point_name = .car.ground.arm_inner location = 0.5, 0.25, 0.1 relative_to = .car.ground.turned
