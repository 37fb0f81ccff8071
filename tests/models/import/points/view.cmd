!
! Own example: a double wishbone as ADAMS/View writes it, with a part that stands in its own frame.
!
defaults units  &
   length = mm  &
   angle = deg  &
   force = newton
model create  &
   model_name = .corner
defaults coordinate_system  &
   default_coordinate_system = .corner
point create  &
   point_name = .corner.ground.hpl_uca_front  &
   location = -100.0, 240.0, 280.8
point create point_name = .corner.ground.hpl_uca_rear location = 130.0, 240.0, 299.2
point create point_name = .corner.ground.hpl_lca_front location = -110.0, 200.0, 122.5
point create point_name = .corner.ground.hpl_lca_rear location = 140.0, 200.0, 117.5
part create rigid_body name_and_position  &
   part_name = .corner.upright  &
   adams_id = 2  &
   location = 12.0, 540.0, 300.0  &
   orientation = 90.0d, 0.0d, 0.0d
part create rigid_body mass_properties  &
   part_name = .corner.upright  &
   mass = 12.0
defaults coordinate_system  &
   default_coordinate_system = .corner.upright
marker create  &
   marker_name = .corner.upright.upper_ball  &
   adams_id = 7  &
   location = 0.0, 0.0, 0.0  &
   orientation = 0.0d, 0.0d, 0.0d
marker create  &
   marker_name = .corner.upright.lower_ball  &
   location = 35.0, 17.0, -190.0   ! the part is turned by 90 deg about z
defaults coordinate_system  &
   default_coordinate_system = .corner
point create point_name = .corner.ground.tie_rod_inner location = 100.0, 230.0, 160.0
point create point_name = .corner.ground.tie_rod_outer location = 110.0, 560.0, 165.0
point create point_name = .corner.ground.wheel_centre location = 0.0, 610.0, 203.0
marker create  &
   marker_name = .corner.ground.on_the_road  &
   location = (LOC_RELATIVE_TO({0, 0, -203}, wheel_centre))
